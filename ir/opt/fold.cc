// Constant folding with the evaluator's own operations, and identities that hold for every value.
// What traps is left to run. A float that is not a number is left, too: as text there is but one.
#include <array>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"
#include "ir/program/eval_scalar.h"
#include "ir/types/not_a_number.h"

namespace ir::opt {
namespace {

class Folder {
 public:
  explicit Folder(Pou& pou)
      : pou_(pou), constants_(pou), same_(pou), definitions_(pou.values.size()) {}

  // Definitions come before their uses in reverse post order.
  bool run() {
    for (const uint32_t b : reverse_post_order(pou_)) {
      for (Inst& inst : pou_.blocks[b].insts) {
        for_each_operand(inst, [this](ValueId& value) { value = same_(value); });
        if (inst.result.valid()) definitions_[inst.result.index] = &inst;
        if (is_scalar_operation(inst.op)) fold(inst);
      }
    }
    same_.apply(pou_);
    return changed_ || !same_.empty();
  }

 private:
  std::optional<uint64_t> constant(const Inst& inst, size_t i) const {
    return constants_[inst.operands[i]];
  }
  Scalar scalar_of(ValueId value) const { return pou_.values[value.index].scalar; }

  const Inst* definition(ValueId value) const { return definitions_[value.index]; }

  void become_constant(Inst& inst, uint64_t bits) {
    const ValueId result = inst.result;
    inst = constant_inst(scalar_of(result), result, bits, inst.line);
    constants_.set(result, inst.imm);
    changed_ = true;
  }

  void become_not(Inst& inst, ValueId operand) {
    changed_ = true;
    inst.op = Op::kNot;
    inst.scalar = Scalar::kBool;
    inst.operands = {operand};
    const ValueId same = identity(inst);
    if (same.valid()) same_.replace(inst.result, same);
  }

  void fold(Inst& inst) {
    if (fold_all(inst)) return;
    const ValueId same = identity(inst);
    if (same.valid()) same_.replace(inst.result, same);
  }

  // All operands are constants, and the operation does not trap.
  bool fold_all(Inst& inst) {
    std::array<uint64_t, 3> operands{};
    for (size_t i = 0; i < inst.operands.size(); ++i) {
      const std::optional<uint64_t> bits = constant(inst, i);
      if (!bits) return false;
      operands[i] = *bits;
    }
    const Outcome outcome = eval_operation(inst, scalar_of(inst.operands[0]), operands);
    if (outcome.trap || is_nan(scalar_of(inst.result), outcome.bits)) return false;
    become_constant(inst, outcome.bits);
    return true;
  }

  // The value that `inst` always equals; it may also become a simpler instruction.
  ValueId identity(Inst& inst) {
    switch (inst.op) {
      case Op::kSelect:
        return select(inst);
      case Op::kNot: {
        const Inst* inner = definition(inst.operands[0]);
        return inner != nullptr && inner->op == Op::kNot ? inner->operands[0] : ValueId();
      }
      case Op::kWrap:
        return wrap(inst);
      case Op::kToBool: {
        const Inst* inner = definition(inst.operands[0]);
        const bool widened = inner != nullptr && inner->op == Op::kWrap &&
                             scalar_of(inner->operands[0]) == Scalar::kBool;
        return widened ? inner->operands[0] : ValueId();
      }
      case Op::kEq:
      case Op::kNe:
      case Op::kLt:
      case Op::kLe:
        return comparison(inst);
      default:
        return is_float(inst.scalar) || inst.operands.size() != 2 ? ValueId() : integers(inst);
    }
  }

  ValueId select(Inst& inst) {
    if (const std::optional<uint64_t> condition = constant(inst, 0)) {
      return inst.operands[*condition != 0 ? 2 : 1];
    }
    if (inst.operands[1] == inst.operands[2]) return inst.operands[1];
    const std::optional<uint64_t> if_false = constant(inst, 1);
    const std::optional<uint64_t> if_true = constant(inst, 2);
    if (!if_false || !if_true) return {};
    if (*if_false == *if_true) return inst.operands[1];
    if (inst.scalar != Scalar::kBool) return {};
    if (*if_true != 0) return inst.operands[0];
    become_not(inst, inst.operands[0]);
    return {};
  }

  // To the same type, or back from a wider one.
  ValueId wrap(const Inst& inst) {
    const ValueId operand = inst.operands[0];
    if (scalar_of(operand) == inst.scalar) return operand;
    const Inst* inner = definition(operand);
    if (inner == nullptr || inner->op != Op::kWrap) return {};
    const Scalar first = scalar_of(inner->operands[0]);
    const bool back = first == inst.scalar && scalar_size(inner->scalar) >= scalar_size(first);
    return back ? inner->operands[0] : ValueId();
  }

  ValueId comparison(Inst& inst) {
    const bool equality = inst.op == Op::kEq || inst.op == Op::kNe;
    if (inst.operands[0] == inst.operands[1] && !is_float(inst.scalar)) {
      become_constant(inst, inst.op == Op::kEq || inst.op == Op::kLe);
      return {};
    }
    if (inst.scalar != Scalar::kBool || !equality) return {};
    for (const size_t i : {0, 1}) {
      const std::optional<uint64_t> bits = constant(inst, i);
      if (!bits) continue;
      const ValueId other = inst.operands[1 - i];
      if ((*bits != 0) == (inst.op == Op::kEq)) return other;
      become_not(inst, other);
      return {};
    }
    return {};
  }

  ValueId integers(Inst& inst) {
    const ValueId left = inst.operands[0];
    const ValueId right = inst.operands[1];
    if (left == right) {
      const bool same =
          inst.op == Op::kAnd || inst.op == Op::kOr || inst.op == Op::kMin || inst.op == Op::kMax;
      if (same) return left;
      if (inst.op == Op::kXor || inst.op == Op::kSub) become_constant(inst, 0);
      return {};
    }
    if (const std::optional<uint64_t> bits = constant(inst, 1)) {
      return with_constant(inst, left, *bits, true);
    }
    if (const std::optional<uint64_t> bits = constant(inst, 0)) {
      return with_constant(inst, right, *bits, false);
    }
    return {};
  }

  // `bits` is the second operand, or the first.
  ValueId with_constant(Inst& inst, ValueId other, uint64_t bits, bool second) {
    const bool ones = bits == canonical(inst.scalar, ~uint64_t{0});
    switch (inst.op) {
      case Op::kAdd:
      case Op::kOr:
        if (bits == 0) return other;
        if (inst.op == Op::kOr && ones) become_constant(inst, bits);
        return {};
      case Op::kXor:
        if (bits == 0) return other;
        if (inst.scalar == Scalar::kBool) become_not(inst, other);
        return {};
      case Op::kAnd:
        if (ones) return other;
        if (bits == 0) become_constant(inst, 0);
        return {};
      case Op::kMul:
        if (bits == 1) return other;
        if (bits == 0) become_constant(inst, 0);
        return {};
      case Op::kSub:
      case Op::kShl:
      case Op::kShr:
      case Op::kRol:
      case Op::kRor:
        return second && bits == 0 ? other : ValueId();
      case Op::kDiv:
        return second && bits == 1 ? other : ValueId();
      default:
        return {};
    }
  }

  Pou& pou_;
  Constants constants_;
  Replacements same_;
  std::vector<const Inst*> definitions_;
  bool changed_ = false;
};

}  // namespace

bool fold_constants(const Program&, Pou& pou) { return Folder(pou).run(); }

}  // namespace ir::opt
