// The exponential function of a number and of what a double leaves out of it. Inside of
// stdlib/native.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#include "stdlib/native/double_double.h"
#include "stdlib/native/roots_of_two.h"

namespace stdlib {

// 2^exponent for a normal result.
constexpr double power_of_two(int64_t exponent) {
  return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

// e^(x + low) for |low| below a unit in the last place of x. x = n * ln 2 / 128 + r,
// |r| < 0.0028; ln 2 / 128 is in two parts, of which the first has 34 bits: its product with n,
// which has 18, is exact. The result is within 0.52 units of the true value.
inline double exponential_of(double x, double low) {
  if (!(x < 710)) return x != x ? x : std::numeric_limits<double>::infinity();
  if (x < -746) return 0;
  constexpr double kStepsPerUnit = 0x1.71547652b82fep+7;
  constexpr Pair kStep = {0x1.62e42fef80000p-8, 0x1.1cf79abc9e3b4p-43};
  const double shifted = x * kStepsPerUnit + kWholeNumbers;
  const double steps = shifted - kWholeNumbers;
  const auto count = static_cast<int64_t>(std::bit_cast<uint64_t>(shifted) << 13) >> 13;
  const Pair& root = kRootsOfTwo[static_cast<uint64_t>(count) & 127];
  const double r = (x - steps * kStep.high) - steps * kStep.low + low;
  const double square = r * r;
  // The first three terms and the next two: what follows is below 2^-60.
  const double growth = (root.low + r) + square * (0.5 + r * (1.0 / 6)) +
                        square * square * (1.0 / 24 + r * (1.0 / 120));
  const int64_t exponent = count >> 7;
  const double mantissa = root.high + root.high * growth;
  if (exponent > -1021 && exponent < 1023) return mantissa * power_of_two(exponent);
  // In two steps, so that overflow and subnormal results come out by themselves.
  const int64_t half = exponent / 2;
  return mantissa * power_of_two(half) * power_of_two(exponent - half);
}

// For -104 <= x <= 89, to 2^-39: enough for a REAL.
inline double short_exponential(double x) {
  constexpr double kStepsPerUnit = 0x1.71547652b82fep+5;
  constexpr double kStep = 0x1.62e42fefa39efp-6;
  const double shifted = x * kStepsPerUnit + kWholeNumbers;
  const auto count = static_cast<int64_t>(std::bit_cast<uint64_t>(shifted) << 13) >> 13;
  const double r = x - (shifted - kWholeNumbers) * kStep;
  const double square = r * r;
  const double growth =
      r + square * (0.5 + r * (1.0 / 6)) + square * square * (1.0 / 24 + r * (1.0 / 120));
  const double root = kRootsOfTwo[(static_cast<uint64_t>(count) & 31) * 4].high;
  return (root + root * growth) * power_of_two(count >> 5);
}

}  // namespace stdlib
