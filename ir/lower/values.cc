#include "ir/lower/values.h"

#include "ir/bytecode/code.h"

namespace ir::codegen {

bool changes_nothing(const Inst& inst, Scalar operand) {
  switch (inst.op) {
    case Op::kCheckRange:
    case Op::kCheckStep:
      return true;
    case Op::kWrap:
    case Op::kToFloat:
    case Op::kBits:
      return class_of(operand) == class_of(inst.scalar);
    case Op::kToBool:
      return operand == Scalar::kBool;
    case Op::kAbs:
      return is_integer(inst.scalar) && !is_signed(inst.scalar);
    default:
      return false;
  }
}

Values::Values(const TypeTable& types, const Pou& pou, const Flow& flow)
    : AliasFacts(types), facts_(pou.values.size()), local_escapes_(pou.locals.size()) {
  define(pou, flow);
  count_uses(pou, flow);
  drop_dead(pou, flow);
}

bool Values::is_pure(const Inst& inst) const {
  if (!inst.result.valid() || inst.place.valid()) return false;
  switch (inst.op) {
    case Op::kCheckRange:
    case Op::kCheckStep:
    case Op::kRound:
    case Op::kTrunc:
    case Op::kCallNative:
    case Op::kTaskTime:
    case Op::kTrapKind:
    case Op::kFlat:  // what is exposed changes from one instruction to the next
    case Op::kUnflat:
      return false;
    case Op::kDiv:
    case Op::kMod:
      return is_float(inst.scalar) ||
             (is_constant(inst.operands[1]) && constant_bits(inst.operands[1]) != 0);
    default:
      return true;
  }
}

bool Values::is_dead(const Inst& inst) const {
  return is_pure(inst) && facts_[inst.result.index].uses == 0;
}

// Uses by dead values do not count. Backwards, so that whole chains go.
void Values::drop_dead(const Pou& pou, const Flow& flow) {
  for (size_t position = flow.blocks.size(); position-- > 0;) {
    if (!flow.blocks[position].source.valid()) continue;
    const std::vector<Inst>& insts = pou.blocks[flow.blocks[position].source.index].insts;
    for (size_t i = insts.size(); i-- > 0;) {
      if (!is_dead(insts[i]) || facts_[insts[i].result.index].same_as.valid()) continue;
      for (ValueId operand : insts[i].operands) --facts_[root(operand).index].uses;
    }
  }
}

ValueId Values::root(ValueId id) const {
  while (facts_[id.index].same_as.valid()) id = facts_[id.index].same_as;
  return id;
}

bool Values::is_constant(ValueId id) const {
  const Inst* definition = facts_[root(id).index].definition;
  return definition != nullptr && definition->op == Op::kConst;
}

uint64_t Values::constant_bits(ValueId id) const { return facts_[root(id).index].definition->imm; }

std::optional<int64_t> Values::constant_index(ValueId id) const {
  if (!is_constant(id)) return std::nullopt;
  return static_cast<int64_t>(constant_bits(id));
}

void Values::define(const Pou& pou, const Flow& flow) {
  for (uint32_t position = 0; position < flow.blocks.size(); ++position) {
    const FlowBlock& flow_block = flow.blocks[position];
    if (!flow_block.source.valid()) continue;
    const Block& block = pou.blocks[flow_block.source.index];
    for (ValueId param : block.params) facts_[param.index].block = position;
    for (const Inst& inst : block.insts) {
      if (!inst.result.valid()) continue;
      ValueFacts& facts = facts_[inst.result.index];
      facts.definition = &inst;
      facts.block = position;
      if (inst.operands.size() == 1 &&
          changes_nothing(inst, pou.values[inst.operands[0].index].scalar)) {
        facts.same_as = inst.operands[0];
      }
    }
  }
}

void Values::use(ValueId id, uint32_t block) {
  ValueFacts& facts = facts_[root(id).index];
  ++facts.uses;
  if (facts.block != block) facts.escapes = true;
}

void Values::use_place(const Pou& pou, PlaceId id, uint32_t block) {
  if (!id.valid()) return;
  const Place& place = pou.places[id.index];
  if (place.value.valid()) use(place.value, block);
  for (const Step& step : place.steps) {
    if (step.value.valid()) use(step.value, block);
  }
}

void Values::count_uses(const Pou& pou, const Flow& flow) {
  for (uint32_t position = 0; position < flow.blocks.size(); ++position) {
    const FlowBlock& flow_block = flow.blocks[position];
    if (!flow_block.source.valid()) {
      for (ValueId arg : flow_block.edge->args) use(arg, position);
      continue;
    }
    for (const Inst& inst : pou.blocks[flow_block.source.index].insts) {
      // A conversion under another name is no use of its own; a check is one.
      const bool renames = inst.result.valid() && facts_[inst.result.index].same_as.valid() &&
                           inst.op != Op::kCheckRange && inst.op != Op::kCheckStep;
      if (!renames) {
        for (ValueId operand : inst.operands) use(operand, position);
      }
      use_place(pou, inst.place, position);
      use_place(pou, inst.place2, position);
      if (inst.op == Op::kJump || inst.op == Op::kEndTry) {
        for (ValueId arg : inst.targets[0].args) use(arg, position);
      }
      if (const auto local = exposed_local(inst, pou)) local_escapes_[*local] = true;
    }
  }
}

}  // namespace ir::codegen
