// Comparison, and the checks that trap on a value.
#pragma once

#include "vm/exec/step.h"

namespace vm {

#define EQUALITY(suffix, T)                      \
  STC_BINARY(EQ_##suffix, T, T, uint8_t, b == c) \
  STC_BINARY(NE_##suffix, T, T, uint8_t, b != c)
STC_VALUES(EQUALITY)

#define ORDER(suffix, T)                        \
  STC_BINARY(LT_##suffix, T, T, uint8_t, b < c) \
  STC_BINARY(LE_##suffix, T, T, uint8_t, b <= c)
STC_SIGNED(ORDER)
STC_UNSIGNED(ORDER)
STC_FLOATS(ORDER)

#define REVERSE_ORDER(suffix, T)                \
  STC_BINARY(GT_##suffix, T, T, uint8_t, b > c) \
  STC_BINARY(GE_##suffix, T, T, uint8_t, b >= c)
STC_SIGNED(REVERSE_ORDER)
STC_UNSIGNED(REVERSE_ORDER)

template <class T>
struct RangeCheck : Stepwise<void> {
  template <class O>
  STC_INLINE Flow step(const O& o, Machine& m, NoValue&) {
    const T value = o.template b<T>();
    const RangeEntry& range = m.ctx->ranges[m.pc->c];
    const bool beyond = std::is_same_v<T, uint64_t> && value > static_cast<T>(INT64_MAX);
    const auto wide = static_cast<int64_t>(value);
    if (beyond || wide < range.low || wide > range.high) [[unlikely]] {
      return trap(m, ir::TrapKind::kSubrange, wide, m.pc->c);
    }
    m.pc += 1;
    return Flow::kOn;
  }
};
#define RANGE_CHECK(suffix, T) \
  template <>                  \
  struct Semantics<ir::Opcode::CHECK_##suffix> : RangeCheck<T> {};
STC_SIGNED(RANGE_CHECK)
STC_UNSIGNED(RANGE_CHECK)

template <class T>
struct StepCheck : Unary<T, void> {
  static constexpr ir::TrapKind kTrap = ir::TrapKind::kForStep;
  static bool fails(T b) { return b == 0; }
};
#define STEP_CHECK(suffix, T) \
  template <>                 \
  struct Semantics<ir::Opcode::CHECK_STEP_##suffix> : StepCheck<T> {};
STC_WORDS(STEP_CHECK)

}  // namespace vm
