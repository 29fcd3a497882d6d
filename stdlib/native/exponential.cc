// Exponential function, logarithms and powers.
#include "stdlib/native/exponential.h"

#include <cmath>
#include <cstdlib>
#include <limits>

#include "stdlib/native/logarithm.h"
#include "stdlib/native/math.h"

namespace stdlib {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Pair kOneOverLn10 = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
constexpr int32_t kMostFactors = 64;  // whole exponents up to here are products

// Not by std::floor, which is a call where the processor may lack an instruction for it. From 2^53
// on all are even.
bool is_integer(double x) {
  return !(std::fabs(x) < 0x1p53) || static_cast<double>(static_cast<int64_t>(x)) == x;
}
bool is_odd(double x) {
  return std::fabs(x) < 0x1p53 && is_integer(x) && (static_cast<int64_t>(x) & 1) != 0;
}

// The logarithm of what is not a finite positive number.
bool outside_logarithm(double x) { return !(x > 0) || x == kInfinity; }
double logarithm_outside(double x) {
  if (x == 0) return -kInfinity;
  return x > 0 ? x : kNan;
}

// |base| is 0 or infinite.
double power_at_edge(double base, double exponent) {
  const bool large = (base != 0) == (exponent > 0);
  const double size = large ? kInfinity : 0;
  return std::signbit(base) && is_odd(exponent) ? -size : size;
}

// base^count for count >= 1.
template <class Number>
Number product(Number base, int32_t count, Number (*times)(Number, Number)) {
  while ((count & 1) == 0) {
    base = times(base, base);
    count >>= 1;
  }
  Number result = base;
  while ((count >>= 1) != 0) {
    base = times(base, base);
    if ((count & 1) != 0) result = times(result, base);
  }
  return result;
}

// Whether base^exponent is a product of few factors, of which none leaves the range in which
// products of pairs have all their bits.
bool is_product(double base, double exponent) {
  if (!(std::fabs(exponent) <= kMostFactors) || !is_integer(exponent)) return false;
  const auto bits = static_cast<int32_t>(std::bit_cast<uint64_t>(base) >> 52 & 0x7ff) - 1023;
  return (std::abs(bits) + 1) * std::fabs(exponent) < 900;
}

double product_power(double base, int32_t exponent) {
  const Pair size = product<Pair>({base, 0}, std::abs(exponent), multiply);
  return exponent > 0 ? size.high : value_of(divide({1, 0}, size));
}

}  // namespace

double exponential(double x) { return exponential_of(x, 0); }

double natural_logarithm(double x) {
  return outside_logarithm(x) ? logarithm_outside(x) : rounded_logarithm(x);
}

double decimal_logarithm(double x) {
  if (outside_logarithm(x)) return logarithm_outside(x);
  return value_of(multiply(logarithm_of(x), kOneOverLn10));
}

double power(double base, double exponent) {
  if (exponent == 0 || base == 1) return 1;
  if (base != base || exponent != exponent) return kNan;
  if (base == 0 || std::fabs(base) == kInfinity) return power_at_edge(base, exponent);
  if (is_product(base, exponent)) return product_power(base, static_cast<int32_t>(exponent));
  if (std::fabs(exponent) == kInfinity && base == -1) return 1;
  if (base < 0 && !is_integer(exponent)) return kNan;
  const double sign = base < 0 && is_odd(exponent) ? -1 : 1;
  if (base == -1) return sign;
  const Pair logarithm = logarithm_of(std::fabs(base));
  // |logarithm| is at least 2^-53: beyond 2^65 the result is 0 or infinite.
  if (std::fabs(exponent) > 0x1p65) {
    return sign * ((logarithm.high > 0) == (exponent > 0) ? kInfinity : 0);
  }
  const Pair scaled = two_product(logarithm.high, exponent);
  return sign * exponential_of(scaled.high, scaled.low + logarithm.low * exponent);
}

namespace real {

float exponential(float x) {
  if (!(x < 89)) return x != x ? x : std::numeric_limits<float>::infinity();
  if (x < -104) return 0;
  return static_cast<float>(short_exponential(x));
}

float natural_logarithm(float x) {
  if (outside_logarithm(x)) return static_cast<float>(logarithm_outside(x));
  return static_cast<float>(short_logarithm(x));
}

float decimal_logarithm(float x) {
  if (outside_logarithm(x)) return static_cast<float>(logarithm_outside(x));
  return static_cast<float>(short_logarithm(x) * kOneOverLn10.high);
}

// Products of up to 64 doubles have an error below 2^-46.
float power(float base, double exponent) {
  if (exponent == 0 || base == 1) return 1;
  if (base != base || exponent != exponent) return static_cast<float>(kNan);
  if (base == 0 || std::fabs(base) == kInfinity) {
    return static_cast<float>(power_at_edge(base, exponent));
  }
  if (std::fabs(exponent) <= kMostFactors && is_integer(exponent)) {
    const auto count = static_cast<int32_t>(exponent);
    const double size = product<double>(
        base, std::abs(count), +[](double a, double b) { return a * b; });
    return static_cast<float>(count > 0 ? size : 1 / size);
  }
  if (base < 0 && !is_integer(exponent)) return static_cast<float>(kNan);
  const double scaled = short_logarithm(std::fabs(base)) * exponent;
  if (scaled != scaled) return 1;  // -1 to the power of infinity
  const double size = scaled > 89 ? kInfinity : scaled < -104 ? 0 : short_exponential(scaled);
  return static_cast<float>(base < 0 && is_odd(exponent) ? -size : size);
}

}  // namespace real
}  // namespace stdlib
