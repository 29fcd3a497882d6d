// Exponential function, logarithms and powers.
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "stdlib/native/math.h"

namespace stdlib {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Pair kLn2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
constexpr Pair kOneOverLn10 = {0x1.bcb7b1526e50ep-2, 0x1.95355baaafad3p-57};
constexpr Pair kThird = {0x1.5555555555555p-2, 0x1.5555555555555p-56};
constexpr Pair kFifth = {0x1.999999999999ap-3, -0x1.999999999999ap-57};

// 2^(j / 32)
constexpr std::array<Pair, 32> kPowersOfTwo = {{
    {0x1.0000000000000p+0, 0x0.0p+0},
    {0x1.059b0d3158574p+0, 0x1.d73e2a475b465p-55},
    {0x1.0b5586cf9890fp+0, 0x1.8a62e4adc610bp-54},
    {0x1.11301d0125b51p+0, -0x1.6c51039449b3ap-54},
    {0x1.172b83c7d517bp+0, -0x1.19041b9d78a76p-55},
    {0x1.1d4873168b9aap+0, 0x1.e016e00a2643cp-54},
    {0x1.2387a6e756238p+0, 0x1.9b07eb6c70573p-54},
    {0x1.29e9df51fdee1p+0, 0x1.612e8afad1255p-55},
    {0x1.306fe0a31b715p+0, 0x1.6f46ad23182e4p-55},
    {0x1.371a7373aa9cbp+0, -0x1.63aeabf42eae2p-54},
    {0x1.3dea64c123422p+0, 0x1.ada0911f09ebcp-55},
    {0x1.44e086061892dp+0, 0x1.89b7a04ef80d0p-59},
    {0x1.4bfdad5362a27p+0, 0x1.d4397afec42e2p-56},
    {0x1.5342b569d4f82p+0, -0x1.07abe1db13cadp-55},
    {0x1.5ab07dd485429p+0, 0x1.6324c054647adp-54},
    {0x1.6247eb03a5585p+0, -0x1.383c17e40b497p-54},
    {0x1.6a09e667f3bcdp+0, -0x1.bdd3413b26456p-54},
    {0x1.71f75e8ec5f74p+0, -0x1.16e4786887a99p-55},
    {0x1.7a11473eb0187p+0, -0x1.41577ee04992fp-55},
    {0x1.82589994cce13p+0, -0x1.d4c1dd41532d8p-54},
    {0x1.8ace5422aa0dbp+0, 0x1.6e9f156864b27p-54},
    {0x1.93737b0cdc5e5p+0, -0x1.75fc781b57ebcp-57},
    {0x1.9c49182a3f090p+0, 0x1.c7c46b071f2bep-56},
    {0x1.a5503b23e255dp+0, -0x1.d2f6edb8d41e1p-54},
    {0x1.ae89f995ad3adp+0, 0x1.7a1cd345dcc81p-54},
    {0x1.b7f76f2fb5e47p+0, -0x1.5584f7e54ac3bp-56},
    {0x1.c199bdd85529cp+0, 0x1.11065895048ddp-55},
    {0x1.cb720dcef9069p+0, 0x1.503cbd1e949dbp-56},
    {0x1.d5818dcfba487p+0, 0x1.2ed02d75b3707p-55},
    {0x1.dfc97337b9b5fp+0, -0x1.1a5cd4f184b5cp-54},
    {0x1.ea4afa2a490dap+0, -0x1.e9c23179c2893p-54},
    {0x1.f50765b6e4540p+0, 0x1.9d3e12dd8a18bp-54},
}};

// 2^exponent for a normal result.
double power_of_two(int32_t exponent) {
  return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

// In two steps, so that overflow and subnormal results come out by themselves.
double scale(double value, int32_t exponent) {
  const int32_t half = exponent >= 0 ? exponent / 2 : -(-exponent / 2);
  return value * power_of_two(half) * power_of_two(exponent - half);
}

// e^x = 2^(n / 32) * e^r with |r| < 0.011. ln 2 / 32 in three parts: the products of the first two
// with n, which has 16 bits, are exact. e^r - 1 is r plus terms below r * 0.0055, whose
// rounding is below 2^-60 of the result.
double exponential_of(Pair x) {
  if (x.high > 710) return kInfinity;
  if (x.high < -746) return 0;
  constexpr double kStepsPerUnit = 0x1.71547652b82fep+5;
  constexpr Pair kStep = {0x1.62e42fe800000p-6, 0x1.e8e7bcd000000p-36};
  constexpr double kStepRest = 0x1.793c7673007e6p-66;
  const double steps = std::floor(x.high * kStepsPerUnit + 0.5);
  Pair rest = two_sum(x.high, -steps * kStep.high);
  rest = add(rest, {-steps * kStep.low, 0});
  rest = add(rest, {x.low - steps * kStepRest, 0});
  const double r = rest.high;
  const double series =
      r * r *
      (1.0 / 2 +
       r * (1.0 / 6 + r * (1.0 / 24 + r * (1.0 / 120 + r * (1.0 / 720 + r * (1.0 / 5040))))));
  const Pair growth = fast_two_sum(r, rest.low + series);
  const auto count = static_cast<int32_t>(steps);
  const Pair& root = kPowersOfTwo[static_cast<uint32_t>(count & 31)];
  const Pair product = two_product(root.high, growth.high);
  const Pair sum = fast_two_sum(root.high, product.high);
  const double low =
      sum.low + (root.low + (product.low + root.high * growth.low + root.low * growth.high));
  return scale(sum.high + low, (count - (count & 31)) / 32);
}

// For finite x > 0. x = 2^n * m with m between the roots of 1/2 and 2; with
// s = (m - 1) / (m + 1), |s| < 0.172, ln m = 2 s (1 + z/3 + z^2/5 + ...), z = s^2. The terms from
// z^3/7 on are plain doubles: their rounding is below 2^-70 of the sum.
Pair logarithm_of(double x) {
  int32_t exponent = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    exponent = -54;
  }
  const auto bits = std::bit_cast<uint64_t>(x);
  exponent += static_cast<int32_t>(bits >> 52) - 1023;
  double m = std::bit_cast<double>((bits & 0xf'ffff'ffff'ffff) | (uint64_t{1023} << 52));
  if (m > 0x1.6a09e667f3bcdp+0) {
    m /= 2;
    ++exponent;
  }
  const Pair s = divide({m - 1, 0}, two_sum(m, 1));
  const Pair z = multiply(s, s);
  double tail = 0;
  for (int32_t divisor = 29; divisor >= 7; divisor -= 2) tail = z.high * tail + 1.0 / divisor;
  const Pair fifth = add(kFifth, {z.high * tail, 0});
  const Pair third = add(kThird, multiply(z, fifth));
  const Pair twice = {2 * s.high, 2 * s.low};
  const Pair small = add(twice, multiply(twice, multiply(z, third)));
  return add(multiply(kLn2, {static_cast<double>(exponent), 0}), small);
}

bool is_integer(double x) { return std::floor(x) == x; }
bool is_odd(double x) { return is_integer(x) && std::floor(x / 2) != x / 2; }

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

}  // namespace

double exponential(double x) { return x == x ? exponential_of({x, 0}) : x; }

double natural_logarithm(double x) {
  return outside_logarithm(x) ? logarithm_outside(x) : value_of(logarithm_of(x));
}

double decimal_logarithm(double x) {
  if (outside_logarithm(x)) return logarithm_outside(x);
  return value_of(multiply(logarithm_of(x), kOneOverLn10));
}

double power(double base, double exponent) {
  if (exponent == 0 || base == 1) return 1;
  if (base != base || exponent != exponent) return kNan;
  if (base == 0 || std::fabs(base) == kInfinity) return power_at_edge(base, exponent);
  if (std::fabs(exponent) == kInfinity && base == -1) return 1;
  if (base < 0 && !is_integer(exponent)) return kNan;
  const double sign = base < 0 && is_odd(exponent) ? -1 : 1;
  if (base == -1) return sign;
  const Pair logarithm = logarithm_of(std::fabs(base));
  // |logarithm| is at least 2^-53: beyond 2^65 the result is 0 or infinite.
  if (std::fabs(exponent) > 0x1p65) {
    return sign * ((logarithm.high > 0) == (exponent > 0) ? kInfinity : 0);
  }
  return sign * exponential_of(multiply(logarithm, {exponent, 0}));
}

}  // namespace stdlib
