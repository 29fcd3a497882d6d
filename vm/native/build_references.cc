// Calls through references: the instance and what stands for the method in its type are looked up
// in tables of the generation, so nothing of it is remembered here. A change brings other tables.
#include "vm/exec/context.h"
#include "vm/native/build.h"
#include "vm/native/host.h"

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

// `may_be_own`: it may be the instance that the POU runs for.
Val Builder::area_of(const Object& object, bool may_be_own) {
  Node made = node(Op::kLoad, 4);
  const Val areas = of_context(offsetof(Context, areas), 8);
  made.mem = {MemBase::kPointer, 1, object.row, offsetof(AreaEntry, data), areas};
  made.immutable = true;
  made.imm = may_be_own ? 0 : kOtherInstance;
  return value_of(made, false);
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
  made.in[1] = area_of(object, kinds == nullptr || facts_.may_be_own(kinds->front()));
  call(kind, pou, made);
}

// An instance is found as for a call.
void Builder::resolve() {
  const ir::TypeId type = ir::region_of_field(x_.x()).type;
  if (facts_.resolves_instance(unit_)) {
    const Object object = object_of(read_b());
    leave_unless_one_of(*facts_.kinds_of(type), object.type);
    return write_a(area_of(object, facts_.may_be_own(type)));
  }
  if (!facts_.follows_bytes(unit_)) return helper();
  const uint64_t size = facts_.image().layouts[type].size;
  const uint64_t bytes = x_.y();
  Node made = node(Op::kResolve, 4, read_b());
  made.imm = size << 32 | bytes;
  made.site = static_cast<uint8_t>(handle_sites_++ % kKnownReaches);
  const size_t before = f_.nodes.size();
  const Val found = value_of(made, false);
  const bool walks = facts_.is_walked(f_.blocks[block_].loop);
  if (f_.nodes.size() != before) f_.nodes.back().exit = exit_here(walks);
  write_a(found);
}

// Of a place in the own instance or the globals; false: of a local, which is exposed by the
// handler.
bool Builder::handle() {
  if (u_.base_b() != ir::Base::kSelf && u_.base_b() != ir::Base::kGlobal) return false;
  const bool own = u_.base_b() == ir::Base::kSelf;
  const Val instance = own ? of_context(offsetof(Context, instance), 4) : zero();
  const Val row = int_op(Op::kMul, 8, instance, constant(sizeof(AreaEntry), 8, false));
  const Val areas = of_context(offsetof(Context, areas), 8);
  const Val segment = of_table(areas, row, offsetof(AreaEntry, segment), 4);
  Val offset = constant(x_.x(), 4, false);
  if (!own) {
    offset = int_op(Op::kSub, 4, offset, of_table(areas, row, offsetof(AreaEntry, data), 4));
  }
  write_a(int_op(Op::kOr, 8, int_op(Op::kShl, 8, segment, constant(32, 4, false)), offset));
  return true;
}

// By so many bytes, as a constant, or to an element.
void Builder::move_handle() {
  if (!host::kFollowsHandles) return helper();
  const Opcode op = u_.opcode();
  Val handle = kNone;
  Val bytes = kNone;
  if (op == Opcode::HANDLE_ADD) {
    handle = read_b();
    bytes = read_c();
  } else if (op == Opcode::HANDLE_STEP) {
    handle = read_b();
    bytes = constant(static_cast<uint64_t>(int64_t{static_cast<int32_t>(x_.x())}), 8, false);
  } else {
    const ir::LinkedBound& bound = facts_.image().bounds[x_.x()];
    const Val index = read_b();
    if (op == Opcode::HANDLE_INDEX_U64) exit_if(Cond::kLtS, 8, index, zero());
    const Val low = constant(static_cast<uint64_t>(bound.low), 8, false);
    const Val steps = int_op(Op::kSub, 8, index, low);
    exit_if(Cond::kGeU, 8, steps, constant(bound.count, 8, false));
    const Val way = int_op(Op::kMul, 8, steps, constant(bound.stride, 8, false));
    handle = read_c();
    bytes = int_op(Op::kAdd, 8, way, constant(x_.y(), 8, false));
  }
  Node made = node(Op::kMoveHandle, 8, handle, bytes);
  made.site = static_cast<uint8_t>(handle_sites_++ % kKnownReaches);
  const size_t before = f_.nodes.size();
  const Val moved = value_of(made, false);
  const bool walks = facts_.is_walked(f_.blocks[block_].loop);
  if (walks && f_.nodes.size() != before) f_.nodes.back().exit = exit_here(true);
  write_a(moved);
}

}  // namespace vm::native
