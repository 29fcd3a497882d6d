// Conversions between scalars.
#pragma once

#include <bit>
#include <cmath>
#include <limits>

#include "vm/exec/step.h"

namespace vm {

#define EXTEND(from, to)                                       \
  STC_UNARY(SEXT_##from##_##to, int##from##_t, int##to##_t, b) \
  STC_UNARY(ZEXT_##from##_##to, uint##from##_t, uint##to##_t, b)
EXTEND(8, 16)
EXTEND(8, 32)
EXTEND(8, 64)
EXTEND(16, 32)
EXTEND(16, 64)
EXTEND(32, 64)

#define NARROW(from, to) STC_UNARY(NARROW_##from##_##to, uint##from##_t, uint##to##_t, b)
NARROW(16, 8)
NARROW(32, 8)
NARROW(32, 16)
NARROW(64, 8)
NARROW(64, 16)
NARROW(64, 32)

STC_UNARY(B_TO_8, Bool, uint8_t, b)
#define TO_BOOL(suffix, T) STC_UNARY(TOBOOL_##suffix, T, uint8_t, b != 0)
STC_WORDS(TO_BOOL)

#define TO_FLOAT(suffix, T)               \
  STC_UNARY(suffix##_TO_F32, T, float, b) \
  STC_UNARY(suffix##_TO_F64, T, double, b)
STC_SIGNED(TO_FLOAT)
STC_UNSIGNED(TO_FLOAT)
STC_UNARY(F32_TO_F64, float, double, b)
STC_UNARY(F64_TO_F32, double, float, b)

STC_UNARY(BITS_32_F32, uint32_t, float, std::bit_cast<float>(b))
STC_UNARY(BITS_F32_32, float, uint32_t, std::bit_cast<uint32_t>(b))
STC_UNARY(BITS_64_F64, uint64_t, double, std::bit_cast<double>(b))
STC_UNARY(BITS_F64_64, double, uint64_t, std::bit_cast<uint64_t>(b))

// Is the whole number `whole` a value of To? Its limits are exact as double, the upper
// one plus 1 too; NaN is none.
template <class To>
constexpr bool expressible(double whole) {
  constexpr double kLow = static_cast<double>(std::numeric_limits<To>::min());
  constexpr double kBehind =
      static_cast<double>(uint64_t{1} << (std::numeric_limits<To>::digits - 1)) * 2.0;
  return whole >= kLow && whole < kBehind;
}

template <class From, class To>
struct FloatToInteger : Unary<From, To> {
  static constexpr ir::TrapKind kTrap = ir::TrapKind::kConversion;
  static int64_t culprit(From b) { return std::bit_cast<int64_t>(static_cast<double>(b)); }
};
// Half to even: the rounding mode of the process is never changed.
template <class From, class To>
struct Round : FloatToInteger<From, To> {
  static bool fails(From b) { return !expressible<To>(std::nearbyint(b)); }
  static To apply(From b) { return static_cast<To>(std::nearbyint(b)); }
};
template <class From, class To>
struct Truncate : FloatToInteger<From, To> {
  static bool fails(From b) { return !expressible<To>(std::trunc(b)); }
  static To apply(From b) { return static_cast<To>(b); }
};
#define TO_INTEGER(suffix, T)                                               \
  template <>                                                               \
  struct Semantics<ir::Opcode::ROUND_F32_##suffix> : Round<float, T> {};    \
  template <>                                                               \
  struct Semantics<ir::Opcode::ROUND_F64_##suffix> : Round<double, T> {};   \
  template <>                                                               \
  struct Semantics<ir::Opcode::TRUNC_F32_##suffix> : Truncate<float, T> {}; \
  template <>                                                               \
  struct Semantics<ir::Opcode::TRUNC_F64_##suffix> : Truncate<double, T> {};
STC_SIGNED(TO_INTEGER)
STC_UNSIGNED(TO_INTEGER)

}  // namespace vm
