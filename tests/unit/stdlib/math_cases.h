// Which functions of stdlib/native/math.h are measured, over which arguments, and how far they may
// be from the truth: the C library's function in extended precision. For math_test.cc and for
// `tests/maths`, which measures as many as it is asked to.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "stdlib/native/math.h"

namespace stdlib::testing {

class Random {
 public:
  explicit Random(uint64_t seed = 0) : state_(88172645463325252u ^ seed * 0x9e3779b97f4a7c15u) {}
  uint64_t bits() {
    state_ ^= state_ << 13;
    state_ ^= state_ >> 7;
    state_ ^= state_ << 17;
    return state_;
  }
  double between(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
  }
  template <class Number>
  Number finite() {
    Number value = std::numeric_limits<Number>::infinity();
    while (!std::isfinite(value)) {
      if constexpr (sizeof(Number) == 4)
        value = std::bit_cast<float>(static_cast<uint32_t>(bits()));
      if constexpr (sizeof(Number) == 8) value = std::bit_cast<double>(bits());
    }
    return value;
  }

 private:
  uint64_t state_;
};

// Distance from the true value in units of its last place; 0 for the nearest number.
template <class Number>
double error_of(Number result, long double truth) {
  constexpr int kDigits = std::numeric_limits<Number>::digits - 1;
  constexpr int kLeast = std::numeric_limits<Number>::min_exponent - 1 - kDigits;
  const auto nearest = static_cast<Number>(truth);
  if (result == nearest || (result != result && nearest != nearest)) return 0;
  if (!std::isfinite(result) || !std::isfinite(nearest)) {
    return std::numeric_limits<double>::infinity();
  }
  const int exponent = nearest == 0 ? kLeast : std::max(std::ilogb(nearest) - kDigits, kLeast);
  return static_cast<double>(std::fabs(result - truth) / std::ldexp(1.0L, exponent));
}

struct Worst {
  double error = 0;
  double x = 0;
  double y = 0;
};

struct MathCase {
  std::string name;
  double bound;  // units in the last place
  std::function<Worst(Random&, uint64_t count)> worst;
};

// `draw` gives an argument; one that is no number lies outside and is left out.
template <class Number, class Draw>
MathCase of_one(std::string name, double bound, Number (*function)(Number),
                long double (*truth)(long double), Draw draw) {
  return {std::move(name), bound, [=](Random& random, uint64_t count) {
            Worst worst;
            for (uint64_t i = 0; i < count; ++i) {
              const auto x = static_cast<Number>(draw(random));
              const double error = error_of(function(x), truth(x));
              if (error > worst.error) worst = {error, x, 0};
            }
            return worst;
          }};
}

// Results that are subnormal are left out: they are rounded twice.
template <class Number, class Second, class Draw>
MathCase of_two(std::string name, double bound, Number (*function)(Number, Second),
                long double (*truth)(long double, long double), Draw draw) {
  return {std::move(name), bound, [=](Random& random, uint64_t count) {
            Worst worst;
            for (uint64_t i = 0; i < count; ++i) {
              const auto [first, second] = draw(random);
              const auto x = static_cast<Number>(first);
              const auto y = static_cast<Second>(second);
              const long double exact = truth(x, y);
              if (std::fabs(exact) < 4 * std::numeric_limits<Number>::min()) continue;
              const double error = error_of(function(x, y), exact);
              if (error > worst.error) worst = {error, x, static_cast<double>(y)};
            }
            return worst;
          }};
}

inline std::vector<MathCase> math_cases() {
  using Long = long double (*)(long double);
  using Long2 = long double (*)(long double, long double);
  struct Two {
    double first, second;
  };
  const auto in = [](double low, double high) {
    return [=](Random& r) { return r.between(low, high); };
  };
  const auto any = [](Random& r) { return r.finite<double>(); };
  const auto above = [](Random& r) { return std::fabs(r.finite<double>()); };
  const auto real = [](Random& r) { return r.finite<float>(); };
  const auto above_real = [](Random& r) { return std::fabs(r.finite<float>()); };
  const auto points = [](Random& r) { return Two{r.between(-3, 3), r.between(-3, 3)}; };
  const auto any_points = [](Random& r) { return Two{r.finite<double>(), r.finite<double>()}; };
  const auto real_points = [](Random& r) { return Two{r.finite<float>(), r.finite<float>()}; };
  const auto powers = [](Random& r) {
    return Two{std::exp(r.between(-20, 20)), r.between(-30, 30)};
  };
  const auto large_powers = [](Random& r) {
    return Two{1 + r.between(-0.01, 0.01), r.between(-70000, 70000)};
  };
  const auto whole_powers = [](Random& r) {
    return Two{r.between(-1000, 1000), std::floor(r.between(-70, 71))};
  };
  const auto real_powers = [](Random& r) {
    return Two{std::exp(r.between(-20, 20)), r.between(-4, 4)};
  };
  const Long sin = std::sin, cos = std::cos, tan = std::tan, asin = std::asin, acos = std::acos,
             atan = std::atan, log = std::log, log10 = std::log10, exp = std::exp;
  const Long2 atan2 = std::atan2, pow = std::pow;
  constexpr double kNear = 0.65;  // half a unit, and what is lost before the last rounding
  constexpr double kReal = 0.51;
  return {
      of_one("SIN small", kNear, sine, sin, in(-0.2, 0.2)),
      of_one("SIN", kNear, sine, sin, in(-10, 10)),
      of_one("SIN of many turns", kNear, sine, sin, in(-2e6, 2e6)),
      of_one("SIN of any", kNear, sine, sin, any),
      of_one("COS", kNear, cosine, cos, in(-10, 10)),
      of_one("COS of many turns", kNear, cosine, cos, in(-2e6, 2e6)),
      of_one("COS of any", kNear, cosine, cos, any),
      of_one("TAN", kNear, tangent, tan, in(-10, 10)),
      of_one("TAN of any", kNear, tangent, tan, any),
      of_one("ASIN", kNear, arc_sine, asin, in(-1, 1)),
      of_one("ACOS", kNear, arc_cosine, acos, in(-1, 1)),
      of_one("ACOS close to 1", kNear, arc_cosine, acos, in(0.9999999, 1)),
      of_one("ATAN", kNear, arc_tangent, atan, in(-20, 20)),
      of_one("ATAN small", kNear, arc_tangent, atan, in(-0.2, 0.2)),
      of_one("ATAN of any", kNear, arc_tangent, atan, any),
      of_two("ATAN2", kNear, arc_tangent2, atan2, points),
      of_two("ATAN2 of any", kNear, arc_tangent2, atan2, any_points),
      of_one("LN close to 1", kNear, natural_logarithm, log, in(0.98, 1.02)),
      of_one("LN", kNear, natural_logarithm, log, in(0.5, 2)),
      of_one("LN of any", kNear, natural_logarithm, log, above),
      of_one("LOG", kNear, decimal_logarithm, log10, in(0.5, 2)),
      of_one("LOG of any", kNear, decimal_logarithm, log10, above),
      of_one("EXP small", kNear, exponential, exp, in(-1, 1)),
      of_one("EXP", kNear, exponential, exp, in(-708, 709.7)),
      of_one("EXP subnormal", 1.1, exponential, exp, in(-750, -700)),
      of_two("EXPT", kNear, power, pow, powers),
      of_two("EXPT close to 1", kNear, power, pow, large_powers),
      of_two("EXPT whole", kNear, power, pow, whole_powers),
      of_one("REAL SIN", kReal, real::sine, sin, real),
      of_one("REAL SIN of few turns", kReal, real::sine, sin, in(-100, 100)),
      of_one("REAL COS", kReal, real::cosine, cos, real),
      of_one("REAL COS of few turns", kReal, real::cosine, cos, in(-100, 100)),
      of_one("REAL TAN", kReal, real::tangent, tan, real),
      of_one("REAL ASIN", kReal, real::arc_sine, asin, in(-1, 1)),
      of_one("REAL ACOS", kReal, real::arc_cosine, acos, in(-1, 1)),
      of_one("REAL ATAN", kReal, real::arc_tangent, atan, real),
      of_two("REAL ATAN2", kReal, real::arc_tangent2, atan2, real_points),
      of_one("REAL LN", kReal, real::natural_logarithm, log, above_real),
      of_one("REAL LN close to 1", kReal, real::natural_logarithm, log, in(0.9, 1.1)),
      of_one("REAL LOG", kReal, real::decimal_logarithm, log10, above_real),
      of_one("REAL EXP", kReal, real::exponential, exp, in(-87, 88.7)),
      of_two("REAL EXPT", kReal, real::power, pow, real_powers),
      of_two("REAL EXPT whole", kReal, real::power, pow, whole_powers),
  };
}

}  // namespace stdlib::testing
