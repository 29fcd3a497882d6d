#include "frontend/lower/handles.h"

#include "ir/types/reach.h"

namespace frontend {

using ir::Op;
using ir::Scalar;

ir::ValueId compared_place(Builder& build, ir::ValueId handle, bool ordered) {
  const ir::ValueId mask = build.constant(Scalar::kU64, ir::kPlaceMask);
  const ir::ValueId place = build.binary(Op::kAnd, Scalar::kU64, handle, mask);
  if (!ordered) return place;
  return build.binary(Op::kXor, Scalar::kU64, place, build.constant(Scalar::kU64, 0x80000000u));
}

bool is_instance_view(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to) {
  return types[to].kind == ir::Kind::kPointer && types.is_instance(types[from].base) &&
         !types.is_instance(types[to].base);
}

// NULL stays NULL.
ir::ValueId whole_instance(Builder& build, ir::ValueId handle) {
  const ir::ValueId null = build.constant(Scalar::kU64, 0);
  const ir::ValueId whole = build.constant(Scalar::kU64, ir::with_away(0, ir::kWhole));
  const ir::ValueId is_set = build.compare(Op::kNe, Scalar::kU64, handle, null);
  const ir::ValueId mark = build.select(Scalar::kU64, is_set, null, whole);
  return build.binary(Op::kOr, Scalar::kU64, compared_place(build, handle, false), mark);
}

}  // namespace frontend
