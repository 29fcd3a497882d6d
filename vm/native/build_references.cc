// Calls through references: the instance and what stands for the method in its type are looked up
// in tables of the generation, so nothing of it is remembered here. A change brings other tables.
#include "vm/exec/context.h"
#include "vm/native/build.h"

namespace vm::native {

using ir::Opcode;

// The Context changes nothing of what is read so while an execution goes on.
Val Builder::of_context(size_t offset, uint8_t width) {
  Node made = node(Op::kContext, width);
  made.imm = offset;
  return value_of(made, false);
}

Val Builder::of_table(Val table, Val row, size_t offset, uint8_t width) {
  Node made = node(Op::kLoad, width);
  made.mem = {MemBase::kPointer, 1, row, static_cast<int64_t>(offset), table};
  made.immutable = true;
  return value_of(made, false);
}

// The instance that the handle names from its first byte on; where there is none the interpreter
// traps. An ID that names the globals goes on: no call is for their type.
Builder::Object Builder::object_of(Val handle) {
  Object out;
  exit_if(Cond::kNe, 4, handle, zero());
  const Val segment = int_op(Op::kShr, 8, handle, constant(32, 4, false));
  const Val number = int_op(Op::kAnd, 4, segment, constant(ir::kSegmentIdMask, 4, false));
  out.id = int_op(Op::kAdd, 4, number, constant(~uint64_t{0}, 4, false));
  exit_if(Cond::kGeU, 4, out.id, of_context(offsetof(Context, instance_count), 4));
  out.row = int_op(Op::kMul, 8, out.id, constant(sizeof(AreaEntry), 8, false));
  const Val areas = of_context(offsetof(Context, areas), 8);
  exit_if(Cond::kNe, 4, of_table(areas, out.row, offsetof(AreaEntry, segment), 4), segment);
  out.type = of_table(areas, out.row, offsetof(AreaEntry, type), 4);
  return out;
}

void Builder::leave_unless_one_of(const std::vector<ir::TypeId>& kinds, Val type) {
  if (kinds.size() == 1) {
    return exit_if(Cond::kNe, 4, type, constant(kinds[0].index, 4, false));
  }
  Val any = kNone;
  for (const ir::TypeId kind : kinds) {
    Node same_type = node(Op::kCompare, 4, type, constant(kind.index, 4, false));
    same_type.cond = Cond::kEq;
    const Val is_it = value_of(same_type, false);
    any = any == kNone ? is_it : int_op(Op::kOr, 1, any, is_it);
  }
  exit_if(Cond::kEq, 1, any, zero());
}

// At the row's first place; where another row lies there, the interpreter looks further and calls.
Val Builder::target_of(Val type, uint32_t prototype) {
  const Val high = int_op(Op::kShl, 8, type, constant(32, 4, false));
  const Val key = int_op(Op::kAdd, 8, high, constant(prototype, 8, false));
  const Val product = int_op(Op::kMul, 8, key, of_context(offsetof(Context, override_factor), 8));
  const Val hash = int_op(Op::kShr, 8, product, constant(32, 4, false));
  const Val place = int_op(Op::kAnd, 8, hash, of_context(offsetof(Context, override_mask), 8));
  static_assert(sizeof(OverrideEntry) == 16);
  const Val row = int_op(Op::kShl, 8, place, constant(4, 4, false));
  const Val table = of_context(offsetof(Context, overrides), 8);
  exit_if(Cond::kNe, 8, of_table(table, row, offsetof(OverrideEntry, key), 8), key);
  return of_table(table, row, offsetof(OverrideEntry, target), 4);
}

void Builder::call_reference() {
  const Opcode op = u_.opcode();
  CallKind kind = CallKind::kVirtual;
  if (op == Opcode::CALL_REF) kind = CallKind::kBody;
  if (op == Opcode::CALL_METHOD_REF) kind = CallKind::kMethod;
  const uint32_t pou = kind == CallKind::kMethod ? x_.x() : 0;
  const auto* const kinds = kind == CallKind::kVirtual ? nullptr : facts_.kinds_called(unit_);
  const bool unknown = kind != CallKind::kVirtual && kinds == nullptr;
  if (unknown || is_slow(kind, pou)) return call(CallKind::kSlow, 0, node(Op::kCall, 0));
  // The interpreter may call, where a check leaves: then it finds all that lives on in memory.
  const bool inlined = facts_.has_body(unit_);
  if (kind == CallKind::kVirtual && !inlined) {
    facts_.each_live_behind(unit_, [&](uint32_t v) { store_slot(v); });
  }
  const Object object = object_of(read_b());
  Node made = node(Op::kCall, 0, object.id);
  if (kinds != nullptr) {
    leave_unless_one_of(*kinds, object.type);
  } else if (inlined) {
    made.in[3] = object.type;
  } else {
    made.in[2] = target_of(object.type, x_.x());
  }
  const Val areas = of_context(offsetof(Context, areas), 8);
  made.in[1] = of_table(areas, object.row, offsetof(AreaEntry, data), 4);
  call(kind, pou, made);
}

}  // namespace vm::native
