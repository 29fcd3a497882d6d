// Registers for values, and instructions whose operands fit the opcode table.
#include "ir/lower/opcodes.h"
#include "ir/lower/select.h"

namespace ir::codegen {
namespace {

Base base_of(Operand operand) {
  if (operand.kind == OperandKind::kConstant) return Base::kConst;
  return operand.kind == OperandKind::kPlace ? operand.base : Base::kFrame;
}

constexpr uint32_t kMaxRegionDepth = 64;

}  // namespace

Class Selector::class_of_value(ValueId value) const {
  return class_of(pou_.values[values_.root(value).index].scalar);
}

Operand Selector::new_register(Class cls, Region region, bool single_use) {
  machine_.registers.push_back({cls, region, kNoNumber, false, single_use, false});
  return Operand::reg(static_cast<uint32_t>(machine_.registers.size() - 1));
}

// The register of a value that is about to be computed, or already is.
Operand Selector::register_for(ValueId value) {
  ValueState& state = states_[value.index];
  if (state.state == State::kInRegister) return Operand::reg(state.register_number);
  const bool param = values_[value].definition == nullptr;
  const Operand made =
      new_register(class_of_value(value), region_of(value), state.remaining == 1 && !param);
  state.state = State::kInRegister;
  state.register_number = made.index;
  return made;
}

Region Selector::region_of(ValueId value) const {
  return class_of_value(value) == Class::kA ? region_of(value, 0) : Region{};
}

// What an addr value points to: the address that made it says so, through block parameters.
Region Selector::region_of(ValueId id, uint32_t depth) const {
  const ValueId value = values_.root(id);
  const Inst* definition = values_[value].definition;
  if (definition != nullptr) {
    return definition->place.valid() ? Region{pou_.places[definition->place.index].type, 0}
                                     : Region{};
  }
  if (depth >= kMaxRegionDepth) return {};
  for (const Block& block : pou_.blocks) {
    for (const Target& target : block.insts.back().targets) {
      const std::vector<ValueId>& params = pou_.blocks[target.block.index].params;
      for (size_t i = 0; i < params.size() && i < target.args.size(); ++i) {
        if (params[i] != value || target.args[i] == value) continue;
        const Region region = region_of(target.args[i], depth + 1);
        if (region.type.valid()) return region;
      }
    }
  }
  return {};
}

Operand Selector::legal_source(const Field& field, Operand operand) {
  if (operand.none() || !field.is_near() || !field.reads() || field.allows(base_of(operand))) {
    return operand;
  }
  const Operand copy = new_register(field.cls, {}, true);
  emit(move_opcode(field.cls), copy, operand);
  return copy;
}

void Selector::emit(Opcode op, Operand a, Operand b, Operand c, uint32_t x, uint32_t y) {
  base::check(op != kNoOpcode, "the bytecode has an instruction for every operation");
  const OpcodeRow& row = opcode_row(op);
  b = legal_source(row.b, b);
  c = legal_source(row.c, c);
  const bool writes = row.a.is_near() && row.a.writes();
  if (!writes) a = legal_source(row.a, a);
  const bool direct = !writes || row.a.allows(base_of(a));
  const Operand dest = direct ? a : new_register(row.a.cls, {}, true);
  block().insts.push_back({op, dest, b, c, x, y, line_});
  if (!direct) block().insts.push_back({move_opcode(row.a.cls), a, dest, {}, 0, 0, line_});
}

// Lets the instruction that made `source` write `dest` at once.
bool Selector::retarget(Operand dest, Operand source) {
  if (!source.is_register() || !machine_.registers[source.index].single_use) return false;
  if (block().insts.empty()) return false;
  MachineInst& last = block().insts.back();
  const Field& field = opcode_row(last.op).a;
  if (last.a != source || !field.is_near() || !field.writes() || field.reads()) return false;
  if (!field.allows(base_of(dest))) return false;
  last.a = dest;
  return true;
}

void Selector::move(Class cls, Operand dest, Operand source) {
  // A BOOL in memory may hold any byte that was written in another way; moved to itself it is 0
  // or 1.
  const bool clean =
      cls != Class::kB || (dest.is_register() && !machine_.registers[dest.index].pinned);
  if ((dest == source && clean) || retarget(dest, source)) return;
  emit(move_opcode(cls), dest, source);
}

}  // namespace ir::codegen
