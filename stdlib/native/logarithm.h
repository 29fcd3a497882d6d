// The natural logarithm of a finite number above 0, as double and with some 16 bits more. Inside of
// stdlib/native.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "stdlib/native/double_double.h"

namespace stdlib {

// One of 128 parts of the mantissas from 0.6875 to 1.375: 1 / c for a c near its middle, in at most
// 10 bits, and ln c = high + low, where `high` is a multiple of 2^-42. Both parts at 1 have c = 1,
// so that logarithms near 0 are exact to the last unit.
struct LogarithmPart {
  double inverse;
  Pair logarithm;
};

// ln m = 2 s (1 + z/3 + z^2/5 + ...) for 0.5 < m < 2; s = (m - 1) / (m + 1), z = s^2.
constexpr Pair logarithm_series(Pair m) {
  const Pair s = divide(add(m, {-1, 0}), add(m, {1, 0}));
  const Pair z = multiply(s, s);
  Pair sum = {0, 0};
  for (int32_t n = 51; n >= 1; n -= 2) {
    sum = add(divide({1, 0}, {static_cast<double>(n), 0}), multiply(z, sum));
  }
  return multiply({2 * s.high, 2 * s.low}, sum);
}

inline constexpr uint64_t kFirstMantissa = 0x3fe6'0000'0000'0000;  // 0.6875

constexpr std::array<LogarithmPart, 128> logarithm_parts() {
  std::array<LogarithmPart, 128> parts = {};
  for (uint64_t i = 0; i < parts.size(); ++i) {
    const double from = std::bit_cast<double>(kFirstMantissa + (i << 45));
    const double to = std::bit_cast<double>(kFirstMantissa + ((i + 1) << 45));
    const bool at_one = from == 1 || to == 1;
    const double inverse =
        at_one ? 1 : static_cast<double>(static_cast<int32_t>(1024 / (from + to) + 0.5)) / 512;
    const Pair logarithm = negate(logarithm_series({inverse, 0}));
    const double high = (logarithm.high + 0x1.8p10) - 0x1.8p10;
    parts[i] = {inverse, {high, add(logarithm, {-high, 0}).high}};
  }
  return parts;
}

inline constexpr std::array<LogarithmPart, 128> kLogarithmParts = logarithm_parts();

// x = 2^exponent * c * (1 + rest), |rest| < 2^-7.
struct LogarithmTerms {
  double high;  // exponent * ln 2 + ln c, exact in high + low to 2^-84
  double low;
  Pair rest;  // exact
};

inline LogarithmTerms logarithm_terms(double x) {
  constexpr Pair kLn2Parts = {0x1.62e42fefa3800p-1, 0x1.ef35793c76730p-45};  // high: 42 bits
  int64_t scaled = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    scaled = 54;
  }
  const auto bits = std::bit_cast<uint64_t>(x);
  const uint64_t above = bits - kFirstMantissa;
  const int64_t whole = static_cast<int64_t>(above) >> 52;
  const auto exponent = static_cast<double>(whole - scaled);
  const LogarithmPart& part = kLogarithmParts[(above >> 45) & 127];
  const uint64_t mantissa = bits - (static_cast<uint64_t>(whole) << 52);
  // Both products are exact: 32 and 21 bits by 10.
  const double front = std::bit_cast<double>(mantissa & ~uint64_t{0x1f'ffff});
  const double back = std::bit_cast<double>(mantissa) - front;
  return {exponent * kLn2Parts.high + part.logarithm.high,
          exponent * kLn2Parts.low + part.logarithm.low,
          two_sum(front * part.inverse - 1, back * part.inverse)};
}

// ln (1 + r) - r + r^2 / 2 for |r| < 2^-7, as a part of r^3, to 2^-47 of it.
inline double logarithm_tail(double r) {
  const double square = r * r;
  const double first = (1.0 / 3 - r * (1.0 / 4)) + square * (1.0 / 5 - r * (1.0 / 6));
  const double second = (1.0 / 7 - r * (1.0 / 8)) + square * (1.0 / 9 - r * (1.0 / 10));
  return first + square * square * second;
}

// To 2^-67.
inline Pair logarithm_of(double x) {
  const LogarithmTerms terms = logarithm_terms(x);
  const double r = terms.rest.high;
  // r^2 / 2 with all its bits that count.
  const double front = std::bit_cast<double>(std::bit_cast<uint64_t>(r) & ~uint64_t{0x7ff'ffff});
  const double square_high = 0.5 * front * front;
  const double square_low = 0.5 * (r - front) * (r + front);
  const Pair first = fast_two_sum(terms.high, r);
  const Pair second = fast_two_sum(first.high, -square_high);
  const double tail = r * r * r * logarithm_tail(r);
  const double rest = terms.rest.low * (1 - r) + terms.low;
  return fast_two_sum(second.high, first.low + (second.low + (rest + (tail - square_low))));
}

// Within 0.52 units.
inline double rounded_logarithm(double x) {
  const LogarithmTerms terms = logarithm_terms(x);
  const double r = terms.rest.high;
  const double sum = terms.high + r;
  const double low = (terms.high - sum) + r + (terms.rest.low + terms.low);
  return sum + (low + r * r * (r * logarithm_tail(r) - 0.5));
}

// Of a REAL, to 2^-34: of 24 bits and 10 the product is exact.
inline double short_logarithm(float x) {
  const auto bits = std::bit_cast<uint64_t>(static_cast<double>(x));
  const uint64_t above = bits - kFirstMantissa;
  const int64_t whole = static_cast<int64_t>(above) >> 52;
  const LogarithmPart& part = kLogarithmParts[(above >> 45) & 127];
  const uint64_t mantissa = bits - (static_cast<uint64_t>(whole) << 52);
  const double r = std::bit_cast<double>(mantissa) * part.inverse - 1;
  const double square = r * r;
  const double tail = (1.0 / 3 - r * (1.0 / 4)) + square * (1.0 / 5);
  return (static_cast<double>(whole) * kLn2.high + part.logarithm.high) +
         (r + square * (r * tail - 0.5));
}

}  // namespace stdlib
