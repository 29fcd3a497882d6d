// The own mathematics against the C library in extended precision, and against itself on
// other machines: the bits of many results are recorded as one number.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <vector>

#include "stdlib/native/math.h"

namespace stdlib::testing {
namespace {

using Function = double (*)(double);
using Reference = long double (*)(long double);

constexpr double kInfinity = std::numeric_limits<double>::infinity();

class Random {
 public:
  uint64_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return state_;
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  double finite() {
    double value = kInfinity;
    while (!std::isfinite(value)) value = std::bit_cast<double>(bits());
    return value;
  }

 private:
  uint64_t state_ = 88172645463325252u;
};

// Distance in units of the last place of the true value.
double error_of(double result, long double truth) {
  const auto nearest = static_cast<double>(truth);
  if (result == nearest || (result != result && nearest != nearest)) return 0;
  if (!std::isfinite(result) || !std::isfinite(nearest)) return kInfinity;
  const int exponent = nearest == 0 ? -1074 : std::max(std::ilogb(nearest) - 52, -1074);
  return static_cast<double>(std::fabs(result - truth) / std::ldexp(1.0L, exponent));
}

double worst_between(Function function, Reference reference, double low, double high) {
  Random random;
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    const double x = random.between(low, high);
    worst = std::max(worst, error_of(function(x), reference(x)));
  }
  return worst;
}

double worst_anywhere(Function function, Reference reference) {
  Random random;
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    const double x = random.finite();
    worst = std::max(worst, error_of(function(x), reference(x)));
  }
  return worst;
}

TEST(Math, SineCosineTangentOfAnyAngle) {
  EXPECT_LT(worst_between(sine, std::sin, -10, 10), 0.6);
  EXPECT_LT(worst_anywhere(sine, std::sin), 0.6);
  EXPECT_LT(worst_between(cosine, std::cos, -10, 10), 0.6);
  EXPECT_LT(worst_anywhere(cosine, std::cos), 0.6);
  EXPECT_LT(worst_between(tangent, std::tan, -10, 10), 0.6);
  EXPECT_LT(worst_anywhere(tangent, std::tan), 0.6);
}

// The double that comes closest to a multiple of pi / 2 (Muller, Elementary Functions, 11.1).
TEST(Math, SineCloseToAMultipleOfPi) {
  const double closest = 6381956970095103.0 * 0x1p797;
  EXPECT_LT(error_of(cosine(closest), std::cos(static_cast<long double>(closest))), 0.6);
  EXPECT_NEAR(cosine(closest), -4.68716592425462761112e-19, 1e-34);
}

TEST(Math, Arcs) {
  EXPECT_LT(worst_between(arc_sine, std::asin, -1, 1), 0.6);
  EXPECT_LT(worst_between(arc_cosine, std::acos, -1, 1), 0.6);
  EXPECT_LT(worst_between(arc_tangent, std::atan, -20, 20), 0.6);
  EXPECT_LT(worst_anywhere(arc_tangent, std::atan), 0.6);
  EXPECT_LT(worst_between(arc_cosine, std::acos, 0.9999999, 1), 0.6);
}

TEST(Math, ArcTangentOfPoints) {
  Random random;
  double worst = 0;
  for (int i = 0; i < 40000; ++i) {
    const double y = i % 2 == 0 ? random.between(-3, 3) : random.finite();
    const double x = i % 2 == 0 ? random.between(-3, 3) : random.finite();
    const long double truth = std::atan2(static_cast<long double>(y), static_cast<long double>(x));
    worst = std::max(worst, error_of(arc_tangent2(y, x), truth));
  }
  EXPECT_LT(worst, 0.6);
}

TEST(Math, LogarithmsAndExponential) {
  EXPECT_LT(worst_between(natural_logarithm, std::log, 0.5, 2), 0.6);
  EXPECT_LT(worst_between(natural_logarithm, std::log, 0, 1e300), 0.6);
  EXPECT_LT(worst_anywhere(natural_logarithm, std::log), 0.6);
  EXPECT_LT(worst_anywhere(decimal_logarithm, std::log10), 0.6);
  EXPECT_LT(worst_between(exponential, std::exp, -1, 1), 0.6);
  EXPECT_LT(worst_between(exponential, std::exp, -708, 709.7), 0.6);
  EXPECT_LT(worst_between(exponential, std::exp, -750, -700), 1.1) << "subnormal results";
}

TEST(Math, Power) {
  Random random;
  double worst = 0;
  for (int i = 0; i < 100000; ++i) {
    const double base = std::exp(random.between(-20, 20));
    const double exponent = random.between(-30, 30);
    const long double truth = std::pow(static_cast<long double>(base), exponent);
    if (truth < 1e-300L) continue;
    worst = std::max(worst, error_of(power(base, exponent), truth));
  }
  EXPECT_LT(worst, 0.6);
}

TEST(Math, ExactResultsAreExact) {
  for (int n = -300; n <= 300; ++n) EXPECT_EQ(power(2, n), std::ldexp(1.0, n));
  for (int n = 0; n <= 22; ++n) {
    EXPECT_EQ(decimal_logarithm(power(10, n)), n);
    EXPECT_EQ(power(-10, n), (n % 2 == 0 ? 1 : -1) * power(10, n));
  }
  EXPECT_EQ(power(10, 22), 1e22);
  EXPECT_EQ(power(0.5, 3), 0.125);
  EXPECT_EQ(power(144, 0.5), 12);
  EXPECT_EQ(exponential(0), 1);
  EXPECT_EQ(natural_logarithm(1), 0);
  EXPECT_EQ(arc_cosine(1), 0);
  EXPECT_EQ(sine(0), 0);
}

bool same(double a, double b) {
  if (a != a || b != b) return a != a && b != b;
  return (a == b && std::signbit(a) == std::signbit(b)) ||
         (std::isfinite(a) && b != 0 && std::fabs(a - b) <= std::fabs(b) * 3e-16);
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

// A REAL result is the double result, rounded once more.
TEST(Math, RealsAreCloserThanOneUnit) {
  Random random;
  for (int i = 0; i < 40000; ++i) {
    const auto x = static_cast<float>(random.between(-100, 100));
    const auto result = static_cast<float>(sine(static_cast<double>(x)));
    const long double truth = std::sin(static_cast<long double>(x));
    const float unit = std::nextafter(std::fabs(result), 2.0f) - std::fabs(result);
    EXPECT_LT(std::fabs(result - truth), unit);
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
  }
  EXPECT_EQ(digest, 7982091063911879193u);
}

}  // namespace
}  // namespace stdlib::testing
