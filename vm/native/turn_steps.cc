#include "vm/native/turn_steps.h"

#include <algorithm>

#include "vm/native/ranges.h"

namespace vm::native {
namespace {

constexpr size_t kMostAsked = 6;  // checks in front of several turns

}  // namespace

TurnSteps::TurnSteps(const Function& function, const Counted& counted) : f_(function), c_(counted) {
  const std::vector<Val>& params = f_.blocks[f_.loops[c_.loop].head].params;
  for (const auto& [param, value] : c_.same) same_[param] = real(value);
  for (const Val param : params) step_[param] = 0;
  for (const uint32_t number : c_.nodes) {
    if (f_.nodes[number].result != kNone) step_[f_.nodes[number].result] = 0;
  }
  // What a turn adds to a parameter of 8 bytes.
  for (size_t i = 0; i < params.size(); ++i) {
    const Value& next = f_.values[c_.again[i]];
    if (f_.values[params[i]].width != 8 || next.constant || next.node == kNone) continue;
    const Node& sum = f_.nodes[next.node];
    const bool adds = sum.op == Op::kAdd && sum.width == 8 && sum.in[0] == params[i];
    if (!adds || !f_.values[sum.in[1]].constant) continue;
    const auto by = static_cast<int64_t>(f_.values[sum.in[1]].bits);
    if (by > -kMostStep && by < kMostStep) step_[params[i]] = by;
  }
  for (const uint32_t number : c_.nodes) find(f_.nodes[number]);
  for (const uint32_t number : c_.nodes) {
    if (asked_.size() < kMostAsked && is_asked_once(f_.nodes[number])) asked_.push_back(number);
  }
}

Val TurnSteps::real(Val v) const {
  const Val* const found = same_.find(v);
  return found == nullptr ? v : *found;
}

int64_t TurnSteps::of(Val v) const {
  const int64_t* const found = step_.find(real(v));
  return found == nullptr ? 0 : *found;
}

bool TurnSteps::is_fixed(Val v) const { return step_.find(real(v)) == nullptr; }

void TurnSteps::find(const Node& n) {
  if (n.result == kNone || n.width != 8) return;
  const int64_t by = step(n);
  if (by >= -kMostStep && by <= kMostStep) step_[n.result] = by;
}

// Sums of 8 bytes: those of the counter's numbers do not wrap, as they are within its limit.
int64_t TurnSteps::step(const Node& n) const {
  const Val a = n.in[0];
  const Val b = n.in[1];
  const auto known = [&](Val v) { return of(v) != 0 || is_fixed(v); };
  const auto times = [&](uint64_t factor) -> int64_t {
    int64_t product;
    const bool wraps =
        factor > INT32_MAX || __builtin_mul_overflow(of(a), static_cast<int64_t>(factor), &product);
    return wraps ? 0 : product;
  };
  switch (n.op) {
    case Op::kSext:
      return real(a) == c_.counter && n.from == f_.values[a].width ? c_.step : 0;
    case Op::kAdd:
      return known(a) && known(b) ? of(a) + of(b) : 0;
    case Op::kSub:
      return known(a) && known(b) ? of(a) - of(b) : 0;
    case Op::kAddShifted:
      return known(a) && known(b) ? of(a) + of(b) * (int64_t{1} << n.imm) : 0;
    case Op::kShl:
      return f_.values[b].constant && f_.values[b].bits < 31
                 ? times(uint64_t{1} << f_.values[b].bits)
                 : 0;
    case Op::kMul:
      return f_.values[b].constant ? times(f_.values[b].bits) : 0;
    default:
      return 0;
  }
}

// Is it below a limit that is not large? Between two such numbers that are near each other there is
// no other one.
bool TurnSteps::is_asked_once(const Node& n) const {
  if (n.op != Op::kExitIf || n.cond != Cond::kGeU || n.width != 8) return false;
  const int64_t by = of(n.in[0]);
  if (by == 0 || by > kMostStep / c_.turns || by < -kMostStep / int64_t{c_.turns}) return false;
  if (!is_fixed(n.in[1])) return false;
  const Value& limit = f_.values[n.in[1]];
  return limit.constant ? limit.bits < uint64_t{1} << 62 : is_far_from_the_ends(f_, n.in[1]);
}

}  // namespace vm::native
