#include "ir/program/eval_scalar.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace ir {
namespace {

uint64_t i(int64_t value) { return static_cast<uint64_t>(value); }
uint64_t f(float value) { return std::bit_cast<uint32_t>(value); }
uint64_t d(double value) { return std::bit_cast<uint64_t>(value); }
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

uint64_t binary(Op op, Scalar scalar, uint64_t a, uint64_t b) {
  const Outcome outcome = eval_binary(op, scalar, a, b);
  EXPECT_FALSE(outcome.trap.has_value());
  return outcome.bits;
}

// Bits, or 0xbad for a conversion trap.
uint64_t convert(Op op, Scalar from, Scalar to, uint64_t a) {
  const Outcome outcome = eval_conversion(op, from, to, a);
  EXPECT_TRUE(!outcome.trap || *outcome.trap == TrapKind::kConversion);
  return outcome.trap ? 0xbad : outcome.bits;
}

TEST(EvalScalar, WrapsInTheWidth) {
  EXPECT_EQ(binary(Op::kAdd, Scalar::kI8, 127, 1), i(-128));
  EXPECT_EQ(binary(Op::kSub, Scalar::kU16, 0, 1), 65535u);
  EXPECT_EQ(binary(Op::kMul, Scalar::kI16, 300, 300), i(24464));
  EXPECT_EQ(binary(Op::kAdd, Scalar::kI64, i(INT64_MAX), 1), i(INT64_MIN));
  EXPECT_EQ(eval_unary(Op::kNeg, Scalar::kI32, i(INT32_MIN)), i(INT32_MIN));
  EXPECT_EQ(eval_unary(Op::kAbs, Scalar::kI8, i(-128)), i(-128));
  EXPECT_EQ(eval_unary(Op::kAbs, Scalar::kU8, 200), 200u);
  EXPECT_EQ(eval_unary(Op::kNot, Scalar::kU8, 0x0f), 0xf0u);
  EXPECT_EQ(eval_unary(Op::kNot, Scalar::kBool, 1), 0u);
}

TEST(EvalScalar, DividesTowardsZero) {
  EXPECT_EQ(binary(Op::kDiv, Scalar::kI16, i(-7), 3), i(-2));
  EXPECT_EQ(binary(Op::kMod, Scalar::kI16, i(-7), 3), i(-1));
  EXPECT_EQ(binary(Op::kMod, Scalar::kI16, 7, i(-3)), 1u);
  EXPECT_EQ(binary(Op::kDiv, Scalar::kI16, i(-32768), i(-1)), i(-32768));
  EXPECT_EQ(binary(Op::kDiv, Scalar::kI64, i(INT64_MIN), i(-1)), i(INT64_MIN));
  EXPECT_EQ(binary(Op::kMod, Scalar::kI64, i(INT64_MIN), i(-1)), 0u);
  EXPECT_EQ(binary(Op::kDiv, Scalar::kU64, ~uint64_t{0}, 2), ~uint64_t{0} / 2);
  const Outcome outcome = eval_binary(Op::kMod, Scalar::kI32, i(-5), 0);
  EXPECT_EQ(outcome.trap, TrapKind::kDivisionByZero);
  EXPECT_EQ(outcome.text, "-5 MOD 0");
  EXPECT_EQ(binary(Op::kDiv, Scalar::kF64, d(1), d(0)), d(INFINITY));
}

TEST(EvalScalar, ComparesBySign) {
  EXPECT_EQ(binary(Op::kLt, Scalar::kI8, i(-1), 1), 1u);
  EXPECT_EQ(binary(Op::kLt, Scalar::kU64, ~uint64_t{0}, 1), 0u);
  EXPECT_EQ(binary(Op::kLe, Scalar::kU64, ~uint64_t{0}, 1), 0u);
  EXPECT_EQ(binary(Op::kLe, Scalar::kI32, 4, 4), 1u);
  EXPECT_EQ(binary(Op::kMin, Scalar::kI32, i(-1), 1), i(-1));
  EXPECT_EQ(binary(Op::kMax, Scalar::kU32, 0xffffffff, 1), 0xffffffffu);
}

TEST(EvalScalar, NanIsNeitherLessNorEqual) {
  EXPECT_EQ(binary(Op::kEq, Scalar::kF64, d(kNan), d(kNan)), 0u);
  EXPECT_EQ(binary(Op::kNe, Scalar::kF64, d(kNan), d(kNan)), 1u);
  EXPECT_EQ(binary(Op::kLe, Scalar::kF64, d(kNan), d(1)), 0u);
  EXPECT_EQ(binary(Op::kEq, Scalar::kF64, d(0.0), d(-0.0)), 1u);
  // The first operand stays where the comparison is FALSE.
  EXPECT_EQ(binary(Op::kMin, Scalar::kF64, d(kNan), d(1)), d(kNan));
  EXPECT_EQ(binary(Op::kMax, Scalar::kF64, d(1), d(kNan)), d(1));
  EXPECT_EQ(binary(Op::kMin, Scalar::kF64, d(0.0), d(-0.0)), d(0.0));
}

TEST(EvalScalar, RealIsSinglePrecision) {
  EXPECT_EQ(binary(Op::kAdd, Scalar::kF32, f(16777216.0f), f(1.0f)), f(16777216.0f));
  EXPECT_EQ(binary(Op::kMul, Scalar::kF32, f(1e30f), f(1e30f)), f(INFINITY));
  EXPECT_EQ(eval_unary(Op::kSqrt, Scalar::kF32, f(2.0f)), f(std::sqrt(2.0f)));
  EXPECT_EQ(eval_unary(Op::kNeg, Scalar::kF64, d(0.0)), d(-0.0));
  EXPECT_EQ(eval_unary(Op::kAbs, Scalar::kF64, d(-0.0)), d(0.0));
}

TEST(EvalScalar, ShiftsAndRotates) {
  EXPECT_EQ(eval_shift(Op::kShl, Scalar::kU8, 0x81, 1), 0x02u);
  EXPECT_EQ(eval_shift(Op::kShl, Scalar::kU8, 0x81, 8), 0u);
  EXPECT_EQ(eval_shift(Op::kShl, Scalar::kU64, 1, 64), 0u);
  EXPECT_EQ(eval_shift(Op::kShr, Scalar::kI8, i(-1), 1), 0x7fu);
  EXPECT_EQ(eval_shift(Op::kShr, Scalar::kI8, i(-1), 0), i(-1));
  EXPECT_EQ(eval_shift(Op::kRol, Scalar::kU8, 0x81, 9), 0x03u);
  EXPECT_EQ(eval_shift(Op::kRor, Scalar::kU16, 1, 1), 0x8000u);
  EXPECT_EQ(eval_shift(Op::kRol, Scalar::kU64, 0x8000000000000001, 64), 0x8000000000000001u);
  EXPECT_EQ(eval_shift(Op::kRor, Scalar::kI16, 1, 1), i(-32768));
}

TEST(EvalScalar, RoundsHalfToEven) {
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI16, d(2.5)), 2u);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI16, d(3.5)), 4u);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF32, Scalar::kI16, f(-2.5f)), i(-2));
  EXPECT_EQ(convert(Op::kTrunc, Scalar::kF32, Scalar::kI16, f(-2.9f)), i(-2));
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kU8, d(-0.5)), 0u);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kU8, d(255.5)), 0xbadu);
  EXPECT_EQ(convert(Op::kTrunc, Scalar::kF64, Scalar::kU8, d(255.9)), 255u);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI8, d(-128.5)), i(-128));
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI64, d(9223372036854775808.0)), 0xbadu);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI64, d(-9223372036854775808.0)),
            i(INT64_MIN));
  EXPECT_EQ(convert(Op::kTrunc, Scalar::kF64, Scalar::kU64, d(18446744073709549568.0)),
            18446744073709549568u);
  EXPECT_EQ(convert(Op::kTrunc, Scalar::kF64, Scalar::kU64, d(-1.0)), 0xbadu);
  EXPECT_EQ(convert(Op::kRound, Scalar::kF64, Scalar::kI64, d(kNan)), 0xbadu);
}

TEST(EvalScalar, Converts) {
  EXPECT_EQ(convert(Op::kWrap, Scalar::kI16, Scalar::kU8, i(-1)), 255u);
  EXPECT_EQ(convert(Op::kWrap, Scalar::kU8, Scalar::kI8, 200), i(-56));
  EXPECT_EQ(convert(Op::kWrap, Scalar::kI8, Scalar::kU32, i(-1)), 0xffffffffu);
  EXPECT_EQ(convert(Op::kToBool, Scalar::kI32, Scalar::kBool, 256), 1u);
  EXPECT_EQ(convert(Op::kToFloat, Scalar::kI64, Scalar::kF32, 16777217), f(16777216.0f));
  EXPECT_EQ(convert(Op::kToFloat, Scalar::kU64, Scalar::kF64, ~uint64_t{0}),
            d(18446744073709551616.0));
  EXPECT_EQ(convert(Op::kToFloat, Scalar::kF64, Scalar::kF32, d(0.1)), f(0.1f));
  EXPECT_EQ(convert(Op::kBits, Scalar::kF32, Scalar::kI32, f(-1.0f)), i(int32_t(0xbf800000)));
  EXPECT_EQ(convert(Op::kBits, Scalar::kI32, Scalar::kF32, i(int32_t(0xbf800000))), f(-1.0f));
}

TEST(EvalScalar, ChecksRanges) {
  EXPECT_FALSE(eval_check_range(Scalar::kI16, i(-10), -10, 10).trap);
  const Outcome outcome = eval_check_range(Scalar::kI16, 11, -10, 10);
  EXPECT_EQ(outcome.trap, TrapKind::kSubrange);
  EXPECT_EQ(outcome.text, "11 outside -10..10");
  EXPECT_FALSE(eval_check_range(Scalar::kU64, ~uint64_t{0}, 1, -1).trap);
}

}  // namespace
}  // namespace ir
