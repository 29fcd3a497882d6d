// Addresses, strings, instances, calls.
#include "vm/native/build.h"

namespace vm::native {

using ir::Opcode;

namespace {

constexpr size_t kMostDirty = 16;  // over a body: every exit of it stores them

// Does it look at no variable but those that its fields name?
bool only_computes(Opcode op) {
  return op == Opcode::LEA || op == Opcode::LEA_AT || op == Opcode::LD_REF ||
         (op >= Opcode::STR && op <= Opcode::WSTR_AT) || op == Opcode::SIZE_OF ||
         op == Opcode::INST || op == Opcode::INST_AT || op == Opcode::TASK_TIME ||
         op == Opcode::HANDLE_ADD || op == Opcode::HANDLE_STEP || op == Opcode::RESOLVE ||
         op == Opcode::HANDLE_INDEX_I64 || op == Opcode::HANDLE_INDEX_U64;
}

}  // namespace

void Builder::special() {
  const Opcode op = u_.opcode();
  if (!only_computes(op) && !facts_.has_body(unit_)) store_deferred();
  switch (op) {
    case Opcode::RESOLVE:
      return resolve();
    case Opcode::HANDLE_ADD:
    case Opcode::HANDLE_STEP:
    case Opcode::HANDLE_INDEX_I64:
    case Opcode::HANDLE_INDEX_U64:
      return move_handle();
    case Opcode::LEA:
      if (u_.base_b() == ir::Base::kConst) return write_a(pool_address(x_.x()));
      return write_a(address_of(place(u_.base_b(), x_.x())));
    case Opcode::LEA_AT:
      return write_a(address_of(behind(read_b(), x_.x())));
    case Opcode::LD_REF:
    case Opcode::LD_REF_AT: {
      const Val found = op == Opcode::LD_REF ? read_field(u_.base_b(), u_.bc(), ir::Class::kA)
                                             : load(behind(read_b(), u_.c), 4, false, false);
      exit_if(Cond::kEq, 4, found, zero());
      return write_a(found);
    }
    case Opcode::ST_REF_AT: {
      Node made = node(Op::kStore, 4, read_b());
      made.mem = behind(read_a(), u_.c);
      append(made);
      return kill_memory();
    }
    case Opcode::STR:
    case Opcode::WSTR:
      if (u_.base_b() == ir::Base::kConst) return make_string(pool_address(x_.x()));
      return make_string(address_of(place(u_.base_b(), x_.x())));
    case Opcode::STR_AT:
    case Opcode::WSTR_AT:
      return make_string(address_of(behind(read_b(), x_.x())));
    case Opcode::SIZE_OF:
      return write_a(constant(x_.x(), 4, false));
    case Opcode::TASK_TIME: {
      Node made = node(Op::kTaskTime, 8);
      made.result = static_cast<Val>(f_.values.size());
      f_.values.push_back({false, 8, false, 0, static_cast<uint32_t>(f_.nodes.size()), block_});
      epoch_of_.push_back(epoch_);
      append(made);
      return write_a(made.result);
    }
    case Opcode::ADVANCE_TIME:
      return append(node(Op::kAdvanceTime, 8, read_b()));
    case Opcode::INST:
      return instance(place(u_.base_b(), u_.bc()), read_field_id(u_.base_b(), u_.bc()));
    case Opcode::INST_AT: {
      const Mem slot = behind(read_b(), u_.c);
      return instance(slot, load_id(slot));
    }
    case Opcode::CALL:
      return call(CallKind::kFunction, u_.c, node(Op::kCall, 0));
    case Opcode::CALL_OWN:
      return call(CallKind::kOwn, u_.c, node(Op::kCall, 0));
    case Opcode::CALL_INST:
    case Opcode::CALL_METHOD: {
      const bool body = op == Opcode::CALL_INST;
      return call_instance(body ? CallKind::kBody : CallKind::kMethod, body ? 0 : x_.x(),
                           place(u_.base_b(), u_.bc()), read_field_id(u_.base_b(), u_.bc()));
    }
    case Opcode::CALL_INST_AT:
    case Opcode::CALL_METHOD_AT: {
      const bool body = op == Opcode::CALL_INST_AT;
      const Mem slot = behind(read_b(), u_.c);
      return call_instance(body ? CallKind::kBody : CallKind::kMethod, body ? 0 : x_.x(), slot,
                           load_id(slot));
    }
    case Opcode::CALL_REF:
    case Opcode::CALL_METHOD_REF:
    case Opcode::CALL_VIRTUAL:
      return call_reference();
    default:
      return call(CallKind::kSlow, 0, node(Op::kCall, 0));
  }
}

Val Builder::read_field_id(ir::Base base, uint32_t offset) {
  return read(facts_.variable({base, offset, ir::Class::k32, true, false, true}));
}

// Where the instance lies whose ID is in the slot, when the image says that; none: the table of
// instances is asked.
std::optional<Mem> Builder::area_of(const Mem& slot) {
  if (slot.base != MemBase::kSelf || slot.inside) return std::nullopt;
  const Children* const all = facts_.children(static_cast<uint64_t>(slot.disp));
  if (all == nullptr) return std::nullopt;
  const int64_t at = slot.disp - all->slot;
  Mem area{MemBase::kSelf, 1, kNone, all->first + all->stride * (at / 4)};
  area.inside = true;
  if (slot.index == kNone) return area;
  if (slot.scale != 4 || at != 0) return std::nullopt;
  const Val stride = constant(static_cast<uint64_t>(all->stride), 8, false);
  area.index = int_op(Op::kMul, 8, slot.index, stride);
  return area;
}

Val Builder::instance_area(const Mem& slot, Val id) {
  if (const std::optional<Mem> area = area_of(slot)) return address_of(*area);
  Node made = node(Op::kInstance, 4, id);
  const size_t before = f_.nodes.size();
  const Val area = value_of(made, false);
  if (f_.nodes.size() != before) f_.nodes.back().exit = exit_here(false);
  return area;
}

void Builder::instance(const Mem& slot, Val id) { write_a(instance_area(slot, id)); }

// A body will stand in its place: values live on, but for what the body changes.
void Builder::call_body(Node made) {
  made.exit = exit_here(true);
  if (f_.exits.back().slots.size() > kMostDirty) {
    f_.exits.pop_back();
    facts_.each_live_behind(unit_, [&](uint32_t v) { store_slot(v); });
    made.exit = exit_here(true);
  }
  f_.exits.back().fuel = true;
  Call& call = f_.calls.back();
  if (call.kind == CallKind::kVirtual) {
    for (const InPlace& here : facts_.bodies_at(unit_)) {
      call.targets.push_back({here.type.index, here.pou});
    }
    call.miss = exit_here(true);
  }
  append(made);
  kill_memory();
}

// Recursion counts its depth.
bool Builder::is_slow(CallKind kind, uint32_t pou) const {
  if (kind == CallKind::kBody) return facts_.recursive_bodies();
  if (kind == CallKind::kVirtual) return facts_.recursive_methods();
  return kind == CallKind::kSlow || facts_.image().pous[pou].recursion_depth != 0;
}

void Builder::call_instance(CallKind kind, uint32_t pou, const Mem& slot, Val id) {
  Node made = node(Op::kCall, 0, id);
  if (is_slow(kind, pou)) return call(kind, pou, made);
  const std::optional<Mem> area = facts_.has_body(unit_) ? area_of(slot) : std::nullopt;
  if (area) {
    made.mem = *area;
  } else {
    made.in[1] = instance_area(slot, id);
  }
  call(kind, pou, made);
}

// Before a call everything is in memory, and after it everything is read from there again.
void Builder::call(CallKind kind, uint32_t pou, Node made) {
  if (is_slow(kind, pou)) kind = CallKind::kSlow;
  made.call = static_cast<uint32_t>(f_.calls.size());
  f_.calls.push_back({kind, pou, uint32_t{u_.a} * 8, unit_, facts_.callee(unit_),
                      facts_.next(unit_), facts_.has_body(unit_)});
  if (f_.calls.back().inlined) return call_body(made);
  facts_.each_live_behind(unit_, [&](uint32_t v) { store_slot(v); });
  if (kind == CallKind::kSlow) {
    made.in[0] = made.in[1] = made.in[2] = kNone;
    for (const Access& access : accesses_of(u_)) {
      const uint32_t v = access.reads ? facts_.variable(access) : kNone;
      if (v != kNone && f_.variables[v].slot) store_slot(v);
    }
  } else {
    made.exit = exit_here(false);  // what the interpreter reads when it calls in our place
  }
  append(made);
  for (uint32_t v = 0; v < f_.variables.size(); ++v) {
    now_.value[v] = kNone;
    now_.dirty[v] = 0;
  }
  forget_everything();
}

}  // namespace vm::native
