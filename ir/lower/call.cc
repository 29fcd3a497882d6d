// Calls: function arguments are already in their slots of the next frame.
#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {

// What an in-out slot points to may change in a call.
void Selector::forget_references() {
  for (CachedAddress& address : addresses_.rows) {
    if (address.by_reference) address.known = false;
  }
}

void Selector::select_call(const Inst& inst) {
  flush_call(inst);
  const uint32_t callee = tables_.callee(program_.pous[inst.pou.index].name);
  emit(Opcode::CALL, {}, {}, Operand::immediate(callee));
  forget_references();
}

void Selector::select_call_instance(const Inst& inst) {
  flush_call(inst);
  const Place& place = pou_.places[inst.place.index];
  if (place.base == PlaceBase::kTarget && place.steps.empty()) {
    emit(Opcode::CALL_REF, {}, use(place.value), {}, tables_.region({place.base_type, 0}));
    return forget_references();
  }
  const Location at = locate(place);
  if (!at.behind_addr) {
    emit(Opcode::CALL_INST, {}, field_of(at));
  } else if (at.place.result.dim == 0 && at.place.steps.empty()) {
    fail(base::Refusal::kTooMany,
         "a function block passed as in-out cannot be called; call it where it is declared");
  } else {
    emit(Opcode::CALL_INST_AT, {}, at.addr, Operand::immediate(offset_of(at)));
  }
  forget_references();
}

void Selector::select_object_call(const Inst& inst) {
  flush_call(inst);
  if (inst.op == Op::kCallReference) {
    emit(Opcode::CALL_REF, {}, use(inst.operands[0]), {}, tables_.region({inst.type, 0}));
    return forget_references();
  }
  const uint32_t callee = tables_.callee(program_.pous[inst.pou.index].name);
  if (inst.place.valid()) {
    select_call_on_place(inst, callee);
  } else if (inst.operands.empty()) {
    emit(Opcode::CALL_OWN, {}, {}, Operand::immediate(callee));
  } else {
    const bool fixed = inst.op == Op::kCallMethod;
    emit(fixed ? Opcode::CALL_METHOD_REF : Opcode::CALL_VIRTUAL, {}, use(inst.operands[0]), {},
         callee);
  }
  forget_references();
}

void Selector::select_call_on_place(const Inst& inst, uint32_t callee) {
  const Place& place = pou_.places[inst.place.index];
  if (place.base == PlaceBase::kTarget && place.steps.empty()) {
    return emit(Opcode::CALL_METHOD_REF, {}, use(place.value), {}, callee);
  }
  const Location at = locate(place);
  if (!at.behind_addr) return emit(Opcode::CALL_METHOD, {}, field_of(at), {}, callee);
  if (at.place.result.dim == 0 && at.place.steps.empty()) {
    return fail(base::Refusal::kTooMany,
                "a method of a function block passed as in-out cannot be called; pass a reference");
  }
  emit(Opcode::CALL_METHOD_AT, {}, at.addr, Operand::immediate(offset_of(at)), callee);
}

void Selector::select_native(const Inst& inst) {
  flush_native(inst);
  for (uint32_t i = 0; i < inst.operands.size(); ++i) {
    const Class cls = class_of_value(inst.operands[i]);
    assign(Operand::slot(tables_.native_slot(i, cls)), inst.operands[i]);
  }
  emit(Opcode::NATIVE, {}, {}, Operand::immediate(inst.native));
  if (!inst.result.valid() || values_[inst.result].uses == 0) return;
  const Class cls = class_of(inst.scalar);
  move(cls, register_for(inst.result), Operand::slot(tables_.native_slot(0, cls)));
}

}  // namespace ir::codegen
