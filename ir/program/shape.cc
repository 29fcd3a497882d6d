#include "ir/program/shape.h"

#include "ir/types/parts.h"

namespace ir {

// Types of a verified program nest finitely; the way down is along array elements only.
bool same_shape(const TypeTable& types, TypeId a, TypeId b) {
  while (a != b) {
    if (types.is_scalar(a) || types.is_scalar(b)) {
      return types.is_scalar(a) && types.is_scalar(b) && types.scalar(a) == types.scalar(b);
    }
    const Type& left = types[a];
    const Type& right = types[b];
    if (left.kind != right.kind || left.capacity != right.capacity || left.dims != right.dims) {
      return false;
    }
    if (left.kind != Kind::kArray) {
      return left.kind == Kind::kString || left.kind == Kind::kWstring;
    }
    a = left.base;
    b = right.base;
  }
  return true;
}

bool can_copy(const TypeTable& types, TypeId to, TypeId from) {
  const Kind kind = types[to].kind;
  const bool strings =
      kind == types[from].kind && (kind == Kind::kString || kind == Kind::kWstring);
  return (strings || same_shape(types, to, from)) && !holds_instance(types, to);
}

}  // namespace ir
