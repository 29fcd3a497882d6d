// The own mathematics against the C library in extended precision, and against itself on
// other machines: the bits of many results are recorded as one number.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/unit/stdlib/math_cases.h"

namespace stdlib::testing {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr long double kHalfPiLong = 1.57079632679489661923132169163975144L;

// No result is a unit in the last place away.
TEST(Math, EveryFunctionIsCloserThanItsBound) {
  for (const MathCase& one : math_cases()) {
    Random random;
    const Worst worst = one.worst(random, 40000);
    EXPECT_LT(worst.error, one.bound) << one.name << " at " << worst.x << ", " << worst.y;
  }
}

// The double that comes closest to a multiple of pi / 2 (Muller, Elementary Functions, 11.1).
TEST(Math, SineCloseToAMultipleOfPi) {
  const double closest = 6381956970095103.0 * 0x1p797;
  EXPECT_LT(error_of(cosine(closest), std::cos(static_cast<long double>(closest))), 0.6);
  EXPECT_NEAR(cosine(closest), -4.68716592425462761112e-19, 1e-34);
}

// Where three parts of pi / 2 have too few bits for what is left.
TEST(Math, SineNextToSmallMultiplesOfPi) {
  for (int k = 1; k < 667'000; ++k) {
    const auto x = static_cast<double>(k * kHalfPiLong);
    const long double exact = x;
    EXPECT_LT(error_of(sine(x), std::sin(exact)), 0.6) << k;
    EXPECT_LT(error_of(cosine(x), std::cos(exact)), 0.6) << k;
    EXPECT_LT(error_of(tangent(x), std::tan(exact)), 0.6) << k;
    const auto y = static_cast<float>(x);
    EXPECT_LT(error_of(real::sine(y), std::sin(static_cast<long double>(y))), 0.51) << k;
    EXPECT_LT(error_of(real::cosine(y), std::cos(static_cast<long double>(y))), 0.51) << k;
  }
}

TEST(Math, ExactResultsAreExact) {
  for (int n = -300; n <= 300; ++n) EXPECT_EQ(power(2, n), std::ldexp(1.0, n));
  for (int n = 0; n <= 22; ++n) {
    EXPECT_EQ(decimal_logarithm(power(10, n)), n);
    EXPECT_EQ(power(-10, n), (n % 2 == 0 ? 1 : -1) * power(10, n));
  }
  for (int n = 0; n <= 10; ++n) EXPECT_EQ(real::power(10, n), static_cast<float>(power(10, n)));
  EXPECT_EQ(power(10, 22), 1e22);
  EXPECT_EQ(power(0.5, 3), 0.125);
  EXPECT_EQ(power(144, 0.5), 12);
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(natural_logarithm(1), 0);
  EXPECT_EQ(arc_cosine(1), 0);
  EXPECT_EQ(sine(0), 0);
}

// Products of pairs would leave their range here.
TEST(Math, WholePowersAtTheEdges) {
  EXPECT_EQ(power(1e200, 2), kInfinity);
  EXPECT_EQ(power(-1e200, 3), -kInfinity);
  EXPECT_EQ(power(1e-200, 2), 0);
  EXPECT_TRUE(std::signbit(power(-1e-200, 3)));
  EXPECT_EQ(power(2, -1074), 5e-324);
  EXPECT_EQ(power(5e-324, 1), 5e-324);
  EXPECT_EQ(power(5e-324, -1), kInfinity);
  EXPECT_EQ(power(1.7976931348623157e308, 1), 1.7976931348623157e308);
  EXPECT_EQ(power(3, 33), 5559060566555523.0);
  EXPECT_EQ(real::power(3e38f, 64), std::numeric_limits<float>::infinity());
  EXPECT_EQ(real::power(-3e38f, 63), -std::numeric_limits<float>::infinity());
  EXPECT_EQ(real::power(1e-45f, -64), std::numeric_limits<float>::infinity());
  EXPECT_EQ(real::power(2, -149), 1e-45f);
}

bool same(double a, double b, double part = 3e-16) {
  if (a != a || b != b) return a != a && b != b;
  return (a == b && std::signbit(a) == std::signbit(b)) ||
         (std::isfinite(a) && b != 0 && std::fabs(a - b) <= std::fabs(b) * part);
}

// IEEE 754-2008, clause 9.2.1, as the C library has it.
TEST(Math, SpecialValues) {
  const std::vector<double> values = {
      0,       -0.0,  1,      -1,        2,          -2,  3,
      -3,      0.5,   -0.5,   kInfinity, -kInfinity, NAN, 5e-324,
      -5e-324, 1e308, -1e308, 1e-308,    1e300,      1.5, 4503599627370497.0};
  for (const double x : values) {
    EXPECT_TRUE(same(sine(x), std::sin(x))) << x;
    EXPECT_TRUE(same(cosine(x), std::cos(x))) << x;
    EXPECT_TRUE(same(tangent(x), std::tan(x))) << x;
    EXPECT_TRUE(same(arc_sine(x), std::asin(x))) << x;
    EXPECT_TRUE(same(arc_cosine(x), std::acos(x))) << x;
    EXPECT_TRUE(same(arc_tangent(x), std::atan(x))) << x;
    EXPECT_TRUE(same(natural_logarithm(x), std::log(x))) << x;
    EXPECT_TRUE(same(decimal_logarithm(x), std::log10(x))) << x;
    EXPECT_TRUE(same(exponential(x), std::exp(x))) << x;
    for (const double y : values) {
      EXPECT_TRUE(same(power(x, y), std::pow(x, y))) << x << " to the " << y;
      EXPECT_TRUE(same(arc_tangent2(x, y), std::atan2(x, y))) << x << " over " << y;
    }
  }
}

TEST(Math, SpecialValuesOfReal) {
  constexpr float kLarge = std::numeric_limits<float>::infinity();
  const std::vector<float> values = {0,      -0.0f,  1,     -1,     2,      -2,      3,
                                     -3,     0.5f,   NAN,   kLarge, 1.5f,   -kLarge, 1e38f,
                                     -1e38f, 1e-38f, 1e30f, -0.5f,  1e-45f, -1e-45f, 8388609};
  const auto close = [](float a, float b) { return same(a, b, 2e-7); };
  for (const float x : values) {
    EXPECT_TRUE(close(real::sine(x), std::sin(x))) << x;
    EXPECT_TRUE(close(real::cosine(x), std::cos(x))) << x;
    EXPECT_TRUE(close(real::tangent(x), std::tan(x))) << x;
    EXPECT_TRUE(close(real::arc_sine(x), std::asin(x))) << x;
    EXPECT_TRUE(close(real::arc_cosine(x), std::acos(x))) << x;
    EXPECT_TRUE(close(real::arc_tangent(x), std::atan(x))) << x;
    EXPECT_TRUE(close(real::natural_logarithm(x), std::log(x))) << x;
    EXPECT_TRUE(close(real::decimal_logarithm(x), std::log10(x))) << x;
    EXPECT_TRUE(close(real::exponential(x), std::exp(x))) << x;
    for (const float y : values) {
      EXPECT_TRUE(close(real::power(x, y), std::pow(x, y))) << x << " to the " << y;
      EXPECT_TRUE(close(real::arc_tangent2(x, y), std::atan2(x, y))) << x << " over " << y;
    }
  }
}

TEST(Math, BitsAreTheSameOnEveryMachine) {
  Random random;
  uint64_t digest = 0;
  auto note = [&](double value) {
    digest = (digest ^ std::bit_cast<uint64_t>(value)) * 0x100000001b3u;
    digest ^= digest >> 29;
  };
  for (int i = 0; i < 20000; ++i) {
    const double x = random.between(-1, 1);
    const double y = random.between(0, 50);
    note(arc_sine(x));
    note(arc_cosine(x));
    note(arc_tangent2(x, y));
    note(sine(y));
    note(cosine(y * 1e30));
    note(tangent(x * y));
    note(exponential(x * y));
    note(natural_logarithm(y));
    note(decimal_logarithm(y));
    note(power(y, x));
    note(power(y, i % 64));
    const auto z = static_cast<float>(y);
    const auto w = static_cast<float>(x);
    note(real::sine(z));
    note(real::cosine(z * 1e30f));
    note(real::tangent(z));
    note(real::exponential(z));
    note(real::natural_logarithm(z));
    note(real::decimal_logarithm(z));
    note(real::arc_sine(w));
    note(real::arc_cosine(w));
    note(real::arc_tangent2(w, z));
    note(real::power(z, x));
  }
  EXPECT_EQ(digest, 1492562688409257770u);
}

}  // namespace
}  // namespace stdlib::testing
