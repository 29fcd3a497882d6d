// Values that wait for their use, and what forces them out earlier.
#include <algorithm>
#include <functional>

#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {

ValueList Selector::operands_of(const Inst& inst) const {
  ValueList out = inst.operands;
  for (PlaceId id : {inst.place, inst.place2}) {
    if (!id.valid()) continue;
    const Place& place = pou_.places[id.index];
    if (place.value.valid()) out.push_back(place.value);
    for (const Step& step : place.steps) {
      if (step.value.valid()) out.push_back(step.value);
    }
  }
  if (inst.op == Op::kJump || inst.op == Op::kEndTry) {
    out.insert(out.end(), inst.targets[0].args);
  }
  return out;
}

// Every pending value that selecting `value` now would use, once per use.
void Selector::count_in_tree(ValueId value, OwnValues& counted) const {
  const ValueId root = values_.root(value);
  const ValueState& state = states_[root.index];
  if (state.state != State::kPending) return;
  counted.push_back(root);
  if (state.place != nullptr) return;
  for (ValueId operand : values_[root].definition->operands) count_in_tree(operand, counted);
}

bool Selector::reads(ValueId value, const Conflicts& conflicts) const {
  const ValueId root = values_.root(value);
  const ValueState& state = states_[root.index];
  if (state.state != State::kPending) return false;
  if (state.place != nullptr) return conflicts(*state.place);
  const ValueList& operands = values_[root].definition->operands;
  return std::any_of(operands.begin(), operands.end(),
                     [&](ValueId operand) { return reads(operand, conflicts); });
}

// What selecting `inst` uses of the pending values, once per use.
Selector::OwnValues Selector::own_values(const Inst& inst) const {
  OwnValues own;
  for (ValueId operand : operands_of(inst)) count_in_tree(operand, own);
  return own;
}

// Gives registers to pending values that read a conflicting place and are not used
// up by `own`.
void Selector::flush(const OwnValues& own, const Conflicts& conflicts) {
  std::erase_if(pending_, [&](ValueId v) { return states_[v.index].state != State::kPending; });
  // Trees first: they use up loads.
  for (const bool loads : {false, true}) {
    for (size_t i = 0; i < pending_.size(); ++i) {
      const ValueId value = pending_[i];
      const ValueState& state = states_[value.index];
      if (state.state != State::kPending || (state.place != nullptr) != loads) continue;
      if (std::count(own.begin(), own.end(), value) >= state.remaining) continue;
      if (!conflicts || reads(value, conflicts)) materialise(value);
    }
  }
}

void Selector::flush_all(const Inst& inst) { flush(own_values(inst), nullptr); }

void Selector::flush_writes(const Inst& inst, const Place& written) {
  if (pending_.empty()) return;
  flush(own_values(inst), [&](const Place& place) { return may_alias(place, written, values_); });
}

void Selector::flush_call(const Inst& inst) {
  flush(own_values(inst), [&](const Place& place) { return calls_may_change(place, values_); });
}

// A native function changes the next frame, already while its arguments are
// stored, and what its string arguments name.
void Selector::flush_native(const Inst& inst) {
  flush({}, [](const Place& place) { return place.base == PlaceBase::kArg; });
  const bool strings = std::any_of(inst.operands.begin(), inst.operands.end(), [&](ValueId v) {
    return class_of_value(v) == Class::kS || class_of_value(v) == Class::kW;
  });
  if (!strings) return;
  flush(own_values(inst), [&](const Place& place) { return calls_may_change(place, values_); });
}

void Selector::consume(ValueId value) {
  ValueState& state = states_[values_.root(value).index];
  if (state.remaining != 0) --state.remaining;
  if (state.remaining == 0 && state.state == State::kPending) state.state = State::kUnseen;
}

void Selector::materialise(ValueId value) {
  ValueState& state = states_[value.index];
  const uint32_t line = line_;
  const Inst& inst = *values_[value].definition;
  line_ = inst.line;
  const bool load = state.place != nullptr;
  const Operand memory = state.memory;
  state.state = State::kUnseen;
  const Operand dest = register_for(value);
  if (load) {
    move(class_of(inst.scalar), dest, memory);
  } else {
    compute(inst, dest);
  }
  line_ = line;
}

Operand Selector::use(ValueId id) {
  const ValueId value = values_.root(id);
  if (values_.is_constant(value)) {
    return Operand::constant(tables_.scalar(class_of_value(value), values_.constant_bits(value)));
  }
  const ValueState state = states_[value.index];
  consume(value);
  if (state.state == State::kInRegister) return Operand::reg(state.register_number);
  base::check(state.state == State::kPending, "a value is used after its definition");
  if (state.place != nullptr) return state.memory;
  const Operand dest = new_register(class_of_value(value), region_of(value), true);
  compute(*values_[value].definition, dest);
  return dest;
}

void Selector::assign(Operand dest, ValueId id) {
  const ValueId value = values_.root(id);
  if (const Inst* definition = pending_definition(value)) {
    consume(value);
    compute(*definition, dest);
    return;
  }
  const Class cls = class_of_value(value);
  move(cls, dest, use(value));
}

// The definition of a pending tree; null for loads, registers and constants.
const Inst* Selector::pending_definition(ValueId id) const {
  const ValueId value = values_.root(id);
  const ValueState& state = states_[value.index];
  if (state.state != State::kPending || state.place != nullptr) return nullptr;
  return values_[value].definition;
}

}  // namespace ir::codegen
