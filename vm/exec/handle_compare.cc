// Comparison, and the checks that trap on a value.
#include "vm/exec/handle.h"

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
struct RangeCheck : Special {
  template <ir::Base A, ir::Base B, ir::Base C>
  STC_INLINE void run(STC_HANDLER_ARGS) {
    const T value = load<T>(STC_AT(B, pc->b));
    const RangeEntry& range = ctx->ranges[pc->c];
    const bool beyond = std::is_same_v<T, uint64_t> && value > static_cast<T>(INT64_MAX);
    const auto wide = static_cast<int64_t>(value);
    if (beyond || wide < range.low || wide > range.high) [[unlikely]] {
      return raise(ctx, ir::TrapKind::kSubrange, pc, frame, self, wide, pc->c);
    }
    STC_NEXT(1);
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

STC_INSTANTIATE_GROUP(kCompareHandlers);

}  // namespace vm
