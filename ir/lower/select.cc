#include "ir/lower/select.h"

#include "ir/lower/opcodes.h"

namespace ir::codegen {
namespace {

constexpr uint32_t kMaxTreeDepth = 64;
constexpr size_t kMaxPending = 512;

}  // namespace

Selector::Selector(const Program& program, const Pou& pou, Object& object)
    : program_(program),
      pou_(pou),
      object_(object),
      tables_(object),
      flow_(order_blocks(pou)),
      values_(program.types, pou, flow_),
      states_(pou.values.size()),
      fixed_(pou.places.size()) {
  for (uint32_t i = 0; i < states_.size(); ++i) states_[i].remaining = values_[ValueId(i)].uses;
}

void Selector::fail(base::Refusal refusal, std::string text) {
  if (!error_) error_ = base::Error{refusal, "POU `" + pou_.name + "`: " + std::move(text)};
}

// Slot numbers of named locals are the numbers of the locals.
void Selector::add_named_slots() {
  for (uint32_t i = 0; i < pou_.locals.size(); ++i) {
    const Local& local = pou_.locals[i];
    const bool in_out = local.kind == LocalKind::kInOut;
    Slot slot;
    slot.kind = local.kind == LocalKind::kTemp ? SlotKind::kLocal : SlotKind::kParam;
    slot.local = local.kind;
    slot.region = {local.type, 0};
    slot.aggregate = !in_out && !types().is_scalar(local.type);
    slot.name = local.name;
    if (in_out) slot.cls = Class::kA;
    if (!in_out && !slot.aggregate) slot.cls = class_of(types().scalar(local.type));
    local_registers_.push_back(kNoNumber);
    if (!slot.aggregate) {
      Register named{slot.cls, slot.region, i, values_.local_escapes(i), false, false};
      named.result = local.kind == LocalKind::kOutput || local.kind == LocalKind::kReturn;
      local_registers_.back() = static_cast<uint32_t>(machine_.registers.size());
      machine_.registers.push_back(named);
    }
    object_.slots.push_back(std::move(slot));
  }
}

// A pointer sees what is behind the end of a text that the caller wrote: zeros, as of a local.
void Selector::clean_given_texts() {
  for (uint32_t i = 0; i < pou_.locals.size(); ++i) {
    const Local& local = pou_.locals[i];
    const bool given = local.kind == LocalKind::kInput && values_.local_escapes(i);
    const Kind kind = types()[local.type].kind;
    if (!given || (kind != Kind::kString && kind != Kind::kWstring)) continue;
    const auto text_in = [&](uint32_t slot) {
      Location at;
      at.place.root = PlaceRoot::kSlot;
      at.place.slot = slot;
      at.place.result = {local.type, 0};
      return at;
    };
    const Location to = text_in(i);
    const Location clean = text_in(static_cast<uint32_t>(object_.slots.size()));
    Slot slot = object_.slots[i];
    slot.kind = SlotKind::kLocal;
    slot.local = LocalKind::kTemp;
    slot.name.clear();
    object_.slots.push_back(std::move(slot));
    copy_whole(clean, local.type, initial_value(local.type, ConstId()));
    copy_value(clean, local.type, to, local.type);
    copy_whole(to, local.type, clean);
  }
}

base::Result<Machine> Selector::run() {
  add_named_slots();
  machine_.blocks.reserve(flow_.blocks.size());
  for (uint32_t position = 0; position < flow_.blocks.size() && !error_; ++position) {
    select_block(position);
  }
  if (error_) return *error_;
  return std::move(machine_);
}

void Selector::select_block(uint32_t position) {
  machine_.blocks.emplace_back();
  addresses_.numbers.clear();
  addresses_.rows.clear();
  pending_.clear();
  const FlowBlock& flow_block = flow_.blocks[position];
  block().handler = flow_block.handler;
  if (!flow_block.source.valid()) {
    select_edge(flow_block);
    return;
  }
  const Block& source = pou_.blocks[flow_block.source.index];
  block().insts.reserve(source.insts.size());
  for (ValueId param : source.params) register_for(param);
  if (position == 0) clean_given_texts();
  for (size_t i = 0; i + 1 < source.insts.size(); ++i) {
    line_ = source.insts[i].line;
    select_inst(source.insts[i]);
  }
  line_ = source.insts.back().line;
  select_end(source.insts.back(), flow_block);
}

void Selector::select_inst(const Inst& inst) {
  switch (inst.op) {
    case Op::kConst:
      return;  // becomes an operand where it is used
    case Op::kLoad:
      return select_load(inst);
    case Op::kStore:
      return select_store(inst);
    case Op::kCopy:
      return select_copy(inst);
    case Op::kInit:
      return select_init(inst);
    case Op::kCheckRange:
    case Op::kCheckStep:
      return select_check(inst);
    case Op::kCallFunction:
      return select_call(inst);
    case Op::kCallInstance:
      return select_call_instance(inst);
    case Op::kCallMethod:
    case Op::kCallBody:
    case Op::kCallVirtual:
    case Op::kCallReference:
      return select_object_call(inst);
    case Op::kCallNative:
      return select_native(inst);
    case Op::kAdvanceTime:
      return emit(Opcode::ADVANCE_TIME, {}, use(inst.operands[0]));
    default:
      return select_value(inst);
  }
}

void Selector::select_value(const Inst& inst) {
  const ValueFacts& facts = values_[inst.result];
  if (facts.same_as.valid() || values_.is_dead(inst)) return;
  const bool names_place = inst.op == Op::kAddress || inst.op == Op::kString;
  if (facts.uses == 0 && names_place && is_static(pou_.places[inst.place.index], values_)) return;
  if (deferrable(inst)) return defer(inst);
  compute(inst, register_for(inst.result));
}

bool Selector::deferrable(const Inst& inst) const {
  const ValueFacts& facts = values_[inst.result];
  if (facts.escapes || facts.uses != 1 || pending_.size() >= kMaxPending) return false;
  if (inst.op == Op::kAddress || inst.op == Op::kString) {
    return is_static(pou_.places[inst.place.index], values_);
  }
  if (!values_.is_pure(inst)) return false;
  for (ValueId operand : inst.operands) {
    if (states_[values_.root(operand).index].depth >= kMaxTreeDepth) return false;
  }
  return true;
}

void Selector::defer(const Inst& inst) {
  ValueState& state = states_[inst.result.index];
  state.state = State::kPending;
  for (ValueId operand : inst.operands) {
    const ValueState& part = states_[values_.root(operand).index];
    if (part.state == State::kPending) state.depth = std::max(state.depth, part.depth);
  }
  ++state.depth;
  pending_.push_back(inst.result);
}

void Selector::select_load(const Inst& inst) {
  const Place& place = pou_.places[inst.place.index];
  const Class cls = class_of(inst.scalar);
  std::optional<uint64_t> bits;
  if (place.base == PlaceBase::kConst && is_static(place, values_)) bits = constant_scalar(place);
  if (bits) return pend_load(inst, Operand::constant(tables_.scalar(cls, *bits)));
  if (inst.scalar == Scalar::kAddr) {
    Location at = locate(place);
    step_dereference(at);
    return move(cls, register_for(inst.result), at.addr);
  }
  if (const Operand fixed = fixed_operand(inst.place, cls); !fixed.none()) {
    return load_memory(inst, fixed);
  }
  const Location at = locate(place);
  if (at.behind_addr) return load_into(at, cls, register_for(inst.result));
  load_memory(inst, fix_operand(inst.place, at, cls));
}

void Selector::load_memory(const Inst& inst, Operand memory) {
  if (pending_.size() >= kMaxPending) {
    return move(class_of(inst.scalar), register_for(inst.result), memory);
  }
  pend_load(inst, memory);
}

void Selector::pend_load(const Inst& inst, Operand memory) {
  if (values_[inst.result].uses == 0) return;
  ValueState& state = states_[inst.result.index];
  state.state = State::kPending;
  state.memory = memory;
  state.place = &pou_.places[inst.place.index];
  pending_.push_back(inst.result);
}

void Selector::select_check(const Inst& inst) {
  const Operand operand = use(inst.operands[0]);
  if (inst.op == Op::kCheckStep) {
    emit(check_step_opcode(inst.scalar), {}, operand);
    return;
  }
  std::string name;
  if (inst.place.valid()) {
    const Place& place = pou_.places[inst.place.index];
    name = place_name(place, place.steps.size());
  }
  const uint32_t range = tables_.range(inst.low, inst.high, name);
  emit(check_range_opcode(inst.scalar), {}, operand, Operand::immediate(range));
}

}  // namespace ir::codegen
