#include "ir/opt/body.h"

#include "ir/program/eval_scalar.h"
#include "stdlib/native/natives.h"

namespace ir::opt {

Constants::Constants(const Pou& pou) : known_(pou.values.size()), bits_(pou.values.size()) {
  for (const Block& block : pou.blocks) {
    for (const Inst& inst : block.insts) {
      if (inst.op != Op::kConst) continue;
      known_[inst.result.index] = true;
      bits_[inst.result.index] = canonical(inst.scalar, inst.imm);
    }
  }
}

void Constants::set(ValueId value, uint64_t bits) {
  if (value.index >= known_.size()) {
    known_.resize(value.index + 1);
    bits_.resize(value.index + 1);
  }
  known_[value.index] = true;
  bits_[value.index] = bits;
}

Inst constant_inst(Scalar scalar, ValueId result, uint64_t bits, uint32_t line) {
  Inst inst;
  inst.op = Op::kConst;
  inst.scalar = scalar;
  inst.result = result;
  inst.imm = canonical(scalar, bits);
  inst.line = line;
  return inst;
}

ValueId new_value(Pou& pou, Scalar scalar) {
  pou.values.push_back({scalar});
  return ValueId(static_cast<uint32_t>(pou.values.size() - 1));
}

bool is_pure(const Inst& inst, const Constants& constants) {
  switch (inst.op) {
    case Op::kConst:
      return true;
    case Op::kCheckRange:
    case Op::kCheckStep:
    case Op::kRound:
    case Op::kTrunc:
      return false;
    case Op::kDiv:
    case Op::kMod:
      return is_float(inst.scalar) || constants[inst.operands[1]].value_or(0) != 0;
    default:
      return is_scalar_operation(inst.op);
  }
}

bool is_pure_native(const Inst& inst) {
  if (inst.op != Op::kCallNative || !inst.result.valid()) return false;
  const stdlib::NativeRow& row = stdlib::native_row(inst.native);
  return row.arguments.find_first_of("SW") == std::string_view::npos;
}

bool is_call(Op op) {
  switch (op) {
    case Op::kCallFunction:
    case Op::kCallInstance:
    case Op::kCallMethod:
    case Op::kCallBody:
    case Op::kCallVirtual:
    case Op::kCallReference:
      return true;
    default:
      return false;
  }
}

Facts::Facts(const Program& program, const Pou& pou)
    : AliasFacts(program.types), constants(pou), escapes_(pou.locals.size()) {
  if (pou.locals.empty()) return;
  for (const Block& block : pou.blocks) {
    for (const Inst& inst : block.insts) {
      if (const auto local = exposed_local(inst, pou)) escapes_[*local] = true;
    }
  }
}

std::optional<int64_t> Facts::constant_index(ValueId value) const {
  const std::optional<uint64_t> bits = constants[value];
  return bits ? std::optional<int64_t>(static_cast<int64_t>(*bits)) : std::nullopt;
}

Replacements::Replacements(const Pou& pou) : by_(pou.values.size()) {}

ValueId Replacements::operator()(ValueId value) {
  ValueId end = value;
  while (end.index < by_.size() && by_[end.index].valid()) end = by_[end.index];
  while (value != end) {
    const ValueId next = by_[value.index];
    by_[value.index] = end;
    value = next;
  }
  return end;
}

void Replacements::apply(Pou& pou) {
  if (empty()) return;
  const auto change = [this](ValueId& value) { value = (*this)(value); };
  for (Block& block : pou.blocks) {
    for (Inst& inst : block.insts) for_each_operand(inst, change);
  }
  for (Place& place : pou.places) for_each_value(place, change);
}

std::vector<uint32_t> count_uses(const Pou& pou) {
  std::vector<uint32_t> uses(pou.values.size());
  std::vector<uint32_t> named(pou.places.size());
  const auto use = [&uses](ValueId value) { ++uses[value.index]; };
  for (const Block& block : pou.blocks) {
    for (const Inst& inst : block.insts) {
      for_each_operand(inst, use);
      if (inst.place.valid()) ++named[inst.place.index];
      if (inst.place2.valid()) ++named[inst.place2.index];
    }
  }
  for (size_t i = 0; i < named.size(); ++i) {
    for_each_value(pou.places[i], [&](ValueId value) { uses[value.index] += named[i]; });
  }
  return uses;
}

Entries count_entries(const Pou& pou) {
  Entries entries{std::vector<uint32_t>(pou.blocks.size()),
                  std::vector<uint32_t>(pou.blocks.size())};
  for (uint32_t b = 0; b < pou.blocks.size(); ++b) {
    for (const Target& target : pou.blocks[b].insts.back().targets) {
      ++entries.count[target.block.index];
      entries.from[target.block.index] = b;
    }
  }
  return entries;
}

}  // namespace ir::opt
