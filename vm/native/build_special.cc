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
         op == Opcode::INST || op == Opcode::INST_AT || op == Opcode::TASK_TIME;
}

}  // namespace

void Builder::special() {
  const Opcode op = u_.opcode();
  if (!only_computes(op) && facts_.body_at(unit_) == nullptr) store_deferred();
  switch (op) {
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
      return instance(read_field_id(u_.base_b(), u_.bc()));
    case Opcode::INST_AT:
      return instance(load_id(behind(read_b(), u_.c)));
    case Opcode::CALL:
      return call(CallKind::kFunction, u_.c, kNone);
    case Opcode::CALL_OWN:
      return call(CallKind::kOwn, u_.c, kNone);
    case Opcode::CALL_INST:
      return call(CallKind::kBody, 0, read_field_id(u_.base_b(), u_.bc()));
    case Opcode::CALL_INST_AT:
      return call(CallKind::kBody, 0, load_id(behind(read_b(), u_.c)));
    case Opcode::CALL_METHOD:
      return call(CallKind::kMethod, x_.x(), read_field_id(u_.base_b(), u_.bc()));
    case Opcode::CALL_METHOD_AT:
      return call(CallKind::kMethod, x_.x(), load_id(behind(read_b(), u_.c)));
    default:
      return call(CallKind::kSlow, 0, kNone);
  }
}

Val Builder::read_field_id(ir::Base base, uint32_t offset) {
  return read(facts_.variable({base, offset, ir::Class::k32, true, false, true}));
}

void Builder::instance(Val id) {
  Node made = node(Op::kInstance, 4, id);
  const size_t before = f_.nodes.size();
  const Val area = value_of(made, false);
  if (f_.nodes.size() != before) f_.nodes.back().exit = exit_here(false);
  write_a(area);
}

// A body will stand in its place: values live on, but for what the body changes.
void Builder::call_body(Node made) {
  made.exit = exit_here(true);
  if (f_.exits.back().slots.size() > kMostDirty) {
    f_.exits.pop_back();
    for (const uint32_t v : facts_.live_behind(unit_)) store_slot(v);
    made.exit = exit_here(true);
  }
  f_.exits.back().fuel = true;
  append(made);
  kill_memory();
}

// Before a call everything is in memory, and behind it everything is read from there again.
void Builder::call(CallKind kind, uint32_t pou, Val id) {
  const std::vector<ir::LinkedPou>& pous = facts_.image().pous;
  if (kind == CallKind::kBody ? facts_.recursive_bodies()
                              : kind != CallKind::kSlow && pous[pou].recursion_depth != 0) {
    kind = CallKind::kSlow;
  }
  Val area = kNone;
  if (kind == CallKind::kBody || kind == CallKind::kMethod) {
    Node made = node(Op::kInstance, 4, id);
    const size_t before = f_.nodes.size();
    area = value_of(made, false);
    if (f_.nodes.size() != before) f_.nodes.back().exit = exit_here(false);
  }
  Node made = node(Op::kCall, 0, id, area);
  made.call = static_cast<uint32_t>(f_.calls.size());
  f_.calls.push_back({kind, pou, uint32_t{u_.a} * 8, unit_, facts_.callee(unit_),
                      facts_.next(unit_), facts_.body_at(unit_) != nullptr});
  if (f_.calls.back().inlined) return call_body(made);
  for (const uint32_t v : facts_.live_behind(unit_)) store_slot(v);
  if (kind == CallKind::kSlow) {
    made.in[0] = made.in[1] = kNone;
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
