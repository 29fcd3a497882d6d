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
constexpr Pair sine_series(Pair r) {
  const Pair z = multiply(r, r);
  double tail = 0;
  for (int32_t n = 18; n >= 4; n -= 2) tail = (1 - z.high * tail) / (n * (n + 1));
  const Pair cube = multiply(multiply(r, z), kMinusSixth);
  const double rest = cube.high * z.high * -tail;
  return add(r, fast_two_sum(cube.high, cube.low + rest));
}

// cos r = 1 - r^2/2 + r^4/24 ...; from r^4 on in plain doubles.
constexpr Pair cosine_series(Pair r) {
  const Pair z = multiply(r, r);
  double tail = 0;
  for (int32_t n = 17; n >= 3; n -= 2) tail = (1 - z.high * tail) / (n * (n + 1));
  const Pair half = {-z.high / 2, -z.low / 2};
  const double rest = half.high * z.high * -tail;
  return add({1, 0}, fast_two_sum(half.high, half.low + rest));
}

double not_a_number() { return std::numeric_limits<double>::quiet_NaN(); }

constexpr double kPartsPerUnit = 64;

struct Direction {
  Pair sine;
  Pair cosine;
};

// Of k / 64, up to pi / 4.
constexpr std::array<Direction, 52> directions() {
  std::array<Direction, 52> all = {};
  for (uint32_t k = 0; k < all.size(); ++k) {
    const Pair angle = {k / kPartsPerUnit, 0};
    all[k] = {sine_series(angle), cosine_series(angle)};
  }
  return all;
}
constexpr std::array<Direction, 52> kDirections = directions();

// |r| = k / 64 + t. sin t and cos t - 1 by the first terms of their series, which are exact to
// 2^-60: |t| is at most 1 / 128.
struct Near {
  const Direction& direction;
  double sine;          // of t
  double cosine_below;  // cos t - 1
};

Near near(Pair r) {
  const bool negative = r.high < 0;
  const double size = negative ? -r.high : r.high;
  const double shifted = size * kPartsPerUnit + kWholeNumbers;
  const double t =
      (size - (shifted - kWholeNumbers) * (1 / kPartsPerUnit)) + (negative ? -r.low : r.low);
  const double square = t * t;
  return {kDirections[std::bit_cast<uint64_t>(shifted) & 63],
          t + t * square * (square * (1.0 / 120) - 1.0 / 6),
          square * (square * (1.0 / 24 - square * (1.0 / 720)) - 0.5)};
}

// |r| <= pi / 4. The sum of both is within 0.06 units of the true value before it is rounded.
Pair short_sine(Pair r) {
  if (std::fabs(r.high) < 0.125) {
    const double z = r.high * r.high;
    const double cube = r.high * z;
    const double tail =
        (1.0 / 120 - z * (1.0 / 5040)) + z * z * (1.0 / 362880 - z * (1.0 / 39916800));
    return {r.high, r.low + cube * (z * tail - 1.0 / 6)};
  }
  const Near at = near(r);
  const Direction& d = at.direction;
  const double low = d.sine.low + d.cosine.low * at.sine + d.sine.high * at.cosine_below;
  const Pair size = {d.sine.high, low + d.cosine.high * at.sine};
  return r.high < 0 ? negate(size) : size;
}

// |r| <= pi / 4, likewise.
Pair short_cosine(Pair r) {
  const Near at = near(r);
  const Direction& d = at.direction;
  const double low = d.cosine.low - d.sine.low * at.sine + d.cosine.high * at.cosine_below;
  return {d.cosine.high, low - d.sine.high * at.sine};
}

// x as reduce_angle has it, for |x| < 2^20 in three parts of pi / 2: the products of the first two,
// which have 33 bits, with the number of quadrants are exact, and so is the first difference.
Reduced reduce(double x) {
  constexpr double kTwoOverPi53 = 0x1.45f306dc9c883p-1;
  constexpr double kFirst = 0x1.921fb544p+0;
  constexpr double kSecond = 0x1.0b4611a6p-34;
  constexpr double kThird = 0x1.3198a2e037073p-69;
  if (std::fabs(x) <= kQuarterPi) return {0, {x, 0}};
  if (!(std::fabs(x) < 0x1p20)) return reduce_angle(x);
  const double shifted = x * kTwoOverPi53 + kWholeNumbers;
  const double quadrants = shifted - kWholeNumbers;
  const Pair rest = two_sum(x - quadrants * kFirst, -quadrants * kSecond);
  // Close to a multiple of pi / 2 the third part has too few bits.
  if (std::fabs(rest.high) < 0x1p-30) return reduce_angle(x);
  return {static_cast<uint32_t>(std::bit_cast<uint64_t>(shifted) & 3),
          fast_two_sum(rest.high, rest.low - quadrants * kThird)};
}

// Of a REAL, |r| <= pi / 4, to 2^-33.
double real_sine(double r) {
  const double z = r * r;
  const double tail =
      (1.0 / 120 - z * (1.0 / 5040)) + z * z * (1.0 / 362880 - z * (1.0 / 39916800));
  return r + r * z * (z * tail - 1.0 / 6);
}
double real_cosine(double r) {
  const double z = r * r;
  const double tail = (1.0 / 24 - z * (1.0 / 720)) + z * z * (1.0 / 40320 - z * (1.0 / 3628800));
  return 1 + z * (z * tail - 0.5);
}

struct RealAngle {
  uint32_t quadrant;
  double angle;
};

// In two parts of pi / 2. No REAL below 2^20 comes closer to a multiple than 2^-28: the tests try
// all that could. The error is 2^-66.
RealAngle reduce(float x) {
  constexpr double kTwoOverPi53 = 0x1.45f306dc9c883p-1;
  constexpr double kFirst = 0x1.921fb544p+0;
  constexpr double kRest = 0x1.0b4611a626331p-34;
  if (!(std::fabs(x) < 0x1p20f)) {
    const Reduced at = reduce_angle(x);
    return {at.quadrant, at.angle.high};
  }
  const double shifted = x * kTwoOverPi53 + kWholeNumbers;
  const double quadrants = shifted - kWholeNumbers;
  return {static_cast<uint32_t>(std::bit_cast<uint64_t>(shifted) & 3),
          (x - quadrants * kFirst) - quadrants * kRest};
}

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
  const Reduced at = reduce(x);
  const double size =
      value_of(at.quadrant % 2 == 0 ? short_sine(at.angle) : short_cosine(at.angle));
  return at.quadrant < 2 ? size : -size;
}

double cosine(double x) {
  if (!std::isfinite(x)) return not_a_number();
  const Reduced at = reduce(x);
  const double size =
      value_of(at.quadrant % 2 == 0 ? short_cosine(at.angle) : short_sine(at.angle));
  return at.quadrant == 0 || at.quadrant == 3 ? size : -size;
}

double tangent(double x) {
  if (std::fabs(x) < kTinyAngle) return x;
  if (!std::isfinite(x)) return not_a_number();
  const Reduced at = reduce(x);
  const Pair sine = short_sine(at.angle);
  const Pair cosine = short_cosine(at.angle);
  return value_of(at.quadrant % 2 == 0 ? short_quotient(sine, cosine)
                                       : short_quotient(negate(cosine), sine));
}

namespace real {

float sine(float x) {
  if (std::fabs(x) < 0x1p-14f) return x;
  if (!std::isfinite(x)) return static_cast<float>(not_a_number());
  const RealAngle at = reduce(x);
  const double size = at.quadrant % 2 == 0 ? real_sine(at.angle) : real_cosine(at.angle);
  return static_cast<float>(at.quadrant < 2 ? size : -size);
}

float cosine(float x) {
  if (!std::isfinite(x)) return static_cast<float>(not_a_number());
  const RealAngle at = reduce(x);
  const double size = at.quadrant % 2 == 0 ? real_cosine(at.angle) : real_sine(at.angle);
  return static_cast<float>(at.quadrant == 0 || at.quadrant == 3 ? size : -size);
}

float tangent(float x) {
  if (std::fabs(x) < 0x1p-14f) return x;
  if (!std::isfinite(x)) return static_cast<float>(not_a_number());
  const RealAngle at = reduce(x);
  const double sine = real_sine(at.angle);
  const double cosine = real_cosine(at.angle);
  return static_cast<float>(at.quadrant % 2 == 0 ? sine / cosine : -cosine / sine);
}

}  // namespace real
}  // namespace stdlib
