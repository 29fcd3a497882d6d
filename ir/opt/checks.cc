// Checks that cannot fail, from what is known about the ranges of values. Variables are not
// trusted: a reference, a union or a person may have written anything into a subrange.
#include <algorithm>
#include <bit>
#include <limits>

#include "ir/opt/body.h"
#include "ir/opt/passes.h"
#include "ir/program/dominators.h"

namespace ir::opt {
namespace {

// The range of an integer or bool; u64 has none, for its values do not fit.
struct Range {
  int64_t low = 0;
  int64_t high = 0;
};
using MaybeRange = std::optional<Range>;

MaybeRange range_of_type(Scalar scalar) {
  if (scalar == Scalar::kBool) return Range{0, 1};
  if (!is_integer(scalar) || scalar == Scalar::kU64) return std::nullopt;
  const uint32_t bits = scalar_size(scalar) * 8;
  if (!is_signed(scalar)) return Range{0, (int64_t{1} << bits) - 1};
  if (bits == 64) {
    return Range{std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max()};
  }
  return Range{-(int64_t{1} << (bits - 1)), (int64_t{1} << (bits - 1)) - 1};
}

bool inside(const Range& inner, const Range& outer) {
  return inner.low >= outer.low && inner.high <= outer.high;
}

// Operations wrap: a result that leaves the type may be anything of it.
MaybeRange sum(Op op, const Range& a, const Range& b) {
  Range out;
  const bool overflow = op == Op::kAdd ? __builtin_add_overflow(a.low, b.low, &out.low) ||
                                             __builtin_add_overflow(a.high, b.high, &out.high)
                                       : __builtin_sub_overflow(a.low, b.high, &out.low) ||
                                             __builtin_sub_overflow(a.high, b.low, &out.high);
  return overflow ? MaybeRange() : MaybeRange(out);
}

MaybeRange product(const Range& a, const Range& b) {
  int64_t ends[4];
  const bool overflow = __builtin_mul_overflow(a.low, b.low, &ends[0]) ||
                        __builtin_mul_overflow(a.low, b.high, &ends[1]) ||
                        __builtin_mul_overflow(a.high, b.low, &ends[2]) ||
                        __builtin_mul_overflow(a.high, b.high, &ends[3]);
  if (overflow) return std::nullopt;
  return Range{*std::min_element(ends, ends + 4), *std::max_element(ends, ends + 4)};
}

class Checks {
 public:
  explicit Checks(Pou& pou) : pou_(pou), same_(pou), ranges_(pou.values.size()) {
    for (uint32_t v = 0; v < pou.values.size(); ++v) {
      ranges_[v] = range_of_type(pou.values[v].scalar);
    }
  }

  bool run() {
    for (const uint32_t b : reverse_post_order(pou_)) {
      Block& block = pou_.blocks[b];
      std::erase_if(block.insts, [this](const Inst& inst) { return look_at(inst); });
    }
    same_.apply(pou_);
    return !same_.empty();
  }

 private:
  // True: a check that goes.
  bool look_at(const Inst& inst) {
    if (inst.op == Op::kCheckRange || inst.op == Op::kCheckStep) {
      if (cannot_fail(inst)) {
        same_.replace(inst.result, inst.operands[0]);
        return true;
      }
    }
    if (!inst.result.valid()) return false;
    MaybeRange& known = ranges_[inst.result.index];
    if (!known) return false;
    const MaybeRange found = result(inst);
    if (found && inside(*found, *known)) known = found;
    return false;
  }

  MaybeRange range(const Inst& inst, size_t i) { return ranges_[same_(inst.operands[i]).index]; }

  bool cannot_fail(const Inst& inst) {
    const MaybeRange value = range(inst, 0);
    if (!value) return false;
    if (inst.op == Op::kCheckStep) return value->low > 0 || value->high < 0;
    return inside(*value, {inst.low, inst.high});
  }

  // nullopt: no more than the type says.
  MaybeRange result(const Inst& inst) {
    if (inst.op == Op::kConst) {
      const int64_t value = static_cast<int64_t>(inst.imm);
      return Range{value, value};
    }
    if (inst.operands.empty() || inst.operands.size() > 3) return std::nullopt;
    const MaybeRange a = range(inst, 0);
    const MaybeRange b = inst.operands.size() > 1 ? range(inst, 1) : MaybeRange();
    if (inst.op == Op::kSelect) return select(b, range(inst, 2));
    if (!a) return std::nullopt;
    if (inst.op == Op::kWrap) return a;
    if (inst.op == Op::kCheckRange) {
      const Range kept{std::max(a->low, inst.low), std::min(a->high, inst.high)};
      return kept.low <= kept.high ? MaybeRange(kept) : std::nullopt;
    }
    return b ? binary(inst.op, *a, *b) : std::nullopt;
  }

  static MaybeRange select(const MaybeRange& a, const MaybeRange& b) {
    if (!a || !b) return std::nullopt;
    return Range{std::min(a->low, b->low), std::max(a->high, b->high)};
  }

  static MaybeRange binary(Op op, const Range& a, const Range& b) {
    switch (op) {
      case Op::kAdd:
      case Op::kSub:
        return sum(op, a, b);
      case Op::kMul:
        return product(a, b);
      case Op::kMin:
        return Range{std::min(a.low, b.low), std::min(a.high, b.high)};
      case Op::kMax:
        return Range{std::max(a.low, b.low), std::max(a.high, b.high)};
      case Op::kAnd:
        if (a.low < 0 && b.low < 0) return std::nullopt;
        if (a.low < 0) return Range{0, b.high};
        if (b.low < 0) return Range{0, a.high};
        return Range{0, std::min(a.high, b.high)};
      case Op::kShr:
        if (a.low < 0 || b.low != b.high || b.low > 62) return std::nullopt;
        return Range{a.low >> b.low, a.high >> b.low};
      case Op::kMod:
        return remainder(a, b);
      case Op::kDiv:
        if (b.low != b.high || b.low <= 0) return std::nullopt;
        return Range{a.low / b.low, a.high / b.low};
      default:
        return std::nullopt;
    }
  }

  static MaybeRange remainder(const Range& a, const Range& b) {
    if (b.low <= 0) return std::nullopt;
    const int64_t most = b.high - 1;
    return Range{a.low >= 0 ? 0 : -most, a.high <= 0 ? 0 : std::min(most, a.high)};
  }

  Pou& pou_;
  Replacements same_;
  std::vector<MaybeRange> ranges_;
};

}  // namespace

bool remove_checks(const Program&, Pou& pou) {
  const auto is_check = [](const Inst& inst) {
    return inst.op == Op::kCheckRange || inst.op == Op::kCheckStep;
  };
  const bool any = std::any_of(pou.blocks.begin(), pou.blocks.end(), [&](const Block& block) {
    return std::any_of(block.insts.begin(), block.insts.end(), is_check);
  });
  return any && Checks(pou).run();
}

}  // namespace ir::opt
