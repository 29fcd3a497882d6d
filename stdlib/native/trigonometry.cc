// Sine, cosine and tangent.
#include <array>
#include <bit>
#include <cmath>
#include <limits>

#include "stdlib/native/math.h"

namespace stdlib {
namespace {

constexpr Pair kMinusSixth = {-0x1.5555555555555p-3, -0x1.5555555555555p-57};
constexpr double kQuarterPi = 0x1.921fb54442d18p-1;
constexpr double kTinyAngle = 0x1p-28;  // below it, sin x and tan x are x within half a unit

// 64 zeros, then the bits of 2 / pi after the point.
constexpr std::array<uint64_t, 20> kTwoOverPi = {
    0x0000000000000000U, 0xa2f9836e4e441529U, 0xfc2757d1f534ddc0U, 0xdb6295993c439041U,
    0xfe5163abdebbc561U, 0xb7246e3a424dd2e0U, 0x06492eea09d1921cU, 0xfe1deb1cb129a73eU,
    0xe88235f52ebb4484U, 0xe99c7026b45f7e41U, 0x3991d639835339f4U, 0x9c845f8bbdf9283bU,
    0x1ff897ffde05980fU, 0xef2f118b5a0a6d1fU, 0x6d367ecf27cb09b7U, 0x4f463f669e5fea2dU,
    0x7527bac7ebe5f17bU, 0x3d0739f78a5292eaU, 0x6bfb5fb11f8d5d08U, 0x56033046fc7b6babU,
};

using Uint128 = unsigned __int128;

// An unsigned fraction of 2^128ths.
Pair fraction(Uint128 value) {
  const auto high = static_cast<double>(value);
  // What rounds up to 2^128 never comes here: |fraction| is at most a half.
  const auto rounded = static_cast<Uint128>(high);
  const double low = rounded > value ? -static_cast<double>(rounded - value)
                                     : static_cast<double>(value - rounded);
  return {high * 0x1p-128, low * 0x1p-128};
}

// sin r = r - r^3/6 + r^5/120 ...; from r^5 on in plain doubles, which is below 0.02 units.
Pair sine_of(Pair r) {
  const Pair z = multiply(r, r);
  double tail = 0;
  for (int32_t n = 18; n >= 4; n -= 2) tail = (1 - z.high * tail) / (n * (n + 1));
  const Pair cube = multiply(multiply(r, z), kMinusSixth);
  const double rest = cube.high * z.high * -tail;
  return add(r, fast_two_sum(cube.high, cube.low + rest));
}

// cos r = 1 - r^2/2 + r^4/24 ...; from r^4 on in plain doubles.
Pair cosine_of(Pair r) {
  const Pair z = multiply(r, r);
  double tail = 0;
  for (int32_t n = 17; n >= 3; n -= 2) tail = (1 - z.high * tail) / (n * (n + 1));
  const Pair half = {-z.high / 2, -z.low / 2};
  const double rest = half.high * z.high * -tail;
  return add({1, 0}, fast_two_sum(half.high, half.low + rest));
}

double not_a_number() { return std::numeric_limits<double>::quiet_NaN(); }

}  // namespace

// After Payne and Hanek: x = m * 2^e with an integer m of 53 bits. Bits of 2 / pi above 2^(1 - e)
// only contribute multiples of 4 to x * 2 / pi, so 192 bits from there on are multiplied. What they
// leave out is below 2^-137, and no double comes closer to a multiple of pi / 2 than 2^-62.
Reduced reduce_angle(double x) {
  if (std::fabs(x) <= kQuarterPi) return {0, {x, 0}};
  const auto bits = std::bit_cast<uint64_t>(std::fabs(x));
  const auto exponent = static_cast<uint32_t>(bits >> 52);  // |x| > 0.7, so 1022 or more
  const uint64_t m = (bits & 0xf'ffff'ffff'ffff) | (uint64_t{1} << 52);
  const uint32_t first = exponent - 1075 + 62;  // e - 2 bits after the point, 64 before it
  const uint32_t word = first / 64;
  const uint32_t shift = first % 64;
  auto window = [&](uint32_t i) {
    const uint64_t above = kTwoOverPi[word + i] << shift;
    return shift == 0 ? above : above | kTwoOverPi[word + i + 1] >> (64 - shift);
  };
  const Uint128 low = Uint128{window(2)} * m;
  const Uint128 middle = Uint128{window(1)} * m + static_cast<uint64_t>(low >> 64);
  const uint64_t high = window(0) * m + static_cast<uint64_t>(middle >> 64);
  const Uint128 product = Uint128{high} << 64 | static_cast<uint64_t>(middle);
  Uint128 rest = product << 2 | static_cast<uint64_t>(low) >> 62;
  const bool up = (rest >> 127) != 0;  // nearer to the next quadrant
  if (up) rest = 0 - rest;
  auto quadrant = static_cast<uint32_t>(high >> 62) + (up ? 1 : 0);
  Pair angle = multiply(fraction(rest), kHalfPi);
  if (up != (x < 0)) angle = negate(angle);
  if (x < 0) quadrant = 0 - quadrant;
  return {quadrant & 3, angle};
}

double sine(double x) {
  if (std::fabs(x) < kTinyAngle) return x;
  if (!std::isfinite(x)) return not_a_number();
  const Reduced at = reduce_angle(x);
  const double size = value_of(at.quadrant % 2 == 0 ? sine_of(at.angle) : cosine_of(at.angle));
  return at.quadrant < 2 ? size : -size;
}

double cosine(double x) {
  if (!std::isfinite(x)) return not_a_number();
  const Reduced at = reduce_angle(x);
  const double size = value_of(at.quadrant % 2 == 0 ? cosine_of(at.angle) : sine_of(at.angle));
  return at.quadrant == 0 || at.quadrant == 3 ? size : -size;
}

double tangent(double x) {
  if (std::fabs(x) < kTinyAngle) return x;
  if (!std::isfinite(x)) return not_a_number();
  const Reduced at = reduce_angle(x);
  const Pair sine = sine_of(at.angle);
  const Pair cosine = cosine_of(at.angle);
  return value_of(at.quadrant % 2 == 0 ? divide(sine, cosine) : divide(negate(cosine), sine));
}

}  // namespace stdlib
