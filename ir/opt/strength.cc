// Powers of two: x * 8 is a shift; unsigned x / 8 and x MOD 8 are a shift and a mask, and whether
// x MOD 8 is zero is a mask for signed x, too.
#include <algorithm>
#include <bit>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/eval_scalar.h"

namespace ir::opt {
namespace {

bool is_product(const Inst& inst) {
  return (inst.op == Op::kMul || inst.op == Op::kDiv || inst.op == Op::kMod) &&
         is_integer(inst.scalar);
}

class Strength {
 public:
  explicit Strength(Pou& pou)
      : pou_(pou), constants_(pou), uses_(count_uses(pou)), definitions_(pou.values.size()) {}

  bool run() {
    for (Block& block : pou_.blocks) {
      made_.clear();
      for (Inst& inst : block.insts) {
        reduce(inst);
        if (inst.op == Op::kMod) definitions_[inst.result.index] = {inst.op, inst.operands};
        made_.push_back(std::move(inst));
      }
      block.insts.swap(made_);
    }
    return changed_;
  }

 private:
  struct Definition {
    Op op = Op::kConst;
    ValueList operands;
  };

  // k where the value is 2 to the power of k, k > 0.
  std::optional<uint32_t> power(ValueId value, Scalar scalar) const {
    const std::optional<uint64_t> bits = constants_[value];
    if (!bits || !std::has_single_bit(*bits) || *bits == 1) return std::nullopt;
    if (is_signed(scalar) && static_cast<int64_t>(*bits) < 0) return std::nullopt;
    return static_cast<uint32_t>(std::countr_zero(*bits));
  }

  ValueId constant(Scalar scalar, uint64_t bits, uint32_t line) {
    const ValueId value = new_value(pou_, scalar);
    made_.push_back(constant_inst(scalar, value, bits, line));
    constants_.set(value, bits);
    definitions_.resize(pou_.values.size());
    changed_ = true;
    return value;
  }

  void reduce(Inst& inst) {
    if (inst.operands.size() != 2 || !is_integer(inst.scalar)) return;
    switch (inst.op) {
      case Op::kMul: {
        if (constants_.known(inst.operands[0])) std::swap(inst.operands[0], inst.operands[1]);
        if (const auto k = power(inst.operands[1], inst.scalar)) shift(inst, Op::kShl, *k);
        return;
      }
      case Op::kDiv:
        if (const auto k = power(inst.operands[1], inst.scalar); k && !is_signed(inst.scalar)) {
          shift(inst, Op::kShr, *k);
        }
        return;
      case Op::kMod:
        if (const auto k = power(inst.operands[1], inst.scalar); k && !is_signed(inst.scalar)) {
          inst.op = Op::kAnd;
          inst.operands[1] = constant(inst.scalar, (uint64_t{1} << *k) - 1, inst.line);
        }
        return;
      case Op::kEq:
      case Op::kNe:
        return divides(inst);
      default:
        return;
    }
  }

  void shift(Inst& inst, Op op, uint32_t count) {
    inst.op = op;
    inst.operands[1] = constant(Scalar::kU32, count, inst.line);
  }

  // x MOD 8 = 0: the low bits say so, whatever the sign.
  void divides(Inst& inst) {
    if (constants_[inst.operands[1]] != uint64_t{0}) return;
    const ValueId remainder = inst.operands[0];
    const Definition& definition = definitions_[remainder.index];
    if (definition.op != Op::kMod || uses_[remainder.index] != 1) return;
    const auto k = power(definition.operands[1], inst.scalar);
    if (!k) return;
    Inst mask;
    mask.op = Op::kAnd;
    mask.scalar = inst.scalar;
    mask.line = inst.line;
    mask.operands = {definition.operands[0],
                     constant(inst.scalar, (uint64_t{1} << *k) - 1, inst.line)};
    mask.result = new_value(pou_, inst.scalar);
    inst.operands[0] = mask.result;
    definitions_.resize(pou_.values.size());
    made_.push_back(std::move(mask));
  }

  Pou& pou_;
  Constants constants_;
  std::vector<uint32_t> uses_;
  std::vector<Definition> definitions_;
  std::vector<Inst> made_;  // of the block at hand
  bool changed_ = false;
};

}  // namespace

bool reduce_strength(const Program&, Pou& pou) {
  const bool any = std::any_of(pou.blocks.begin(), pou.blocks.end(), [](const Block& block) {
    return std::any_of(block.insts.begin(), block.insts.end(), is_product);
  });
  return any && Strength(pou).run();
}

}  // namespace ir::opt
