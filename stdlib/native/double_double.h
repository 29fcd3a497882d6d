// Numbers of twice the precision of double, as an unevaluated sum: |low| is at
// most half a unit in the last place of `high`. Only IEEE 754 addition,
// subtraction, multiplication and division occur, so every machine computes the same bits
// (ARCHITECTURE.md, invariant 5). The error of add, multiply and divide is below
// 2^-100 of the result, as long as nothing overflows or becomes subnormal; callers scale.
// The algorithms are those of Dekker (1971) and Knuth (TAOCP 4.2.2).
#pragma once

#include <cstdint>

namespace stdlib {

struct Pair {
  double high = 0;
  double low = 0;
};

// a + b without error.
constexpr Pair two_sum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

// The sum of both and its error, when |a| >= |b| or a is 0.
constexpr Pair fast_two_sum(double a, double b) {
  const double sum = a + b;
  return {sum, b - (sum - a)};
}

// a as a sum of two numbers of 26 bits. |a| < 2^996.
constexpr Pair split(double a) {
  const double scaled = 134217729.0 * a;  // 2^27 + 1
  const double high = scaled - (scaled - a);
  return {high, a - high};
}

// a * b without error.
constexpr Pair two_product(double a, double b) {
  const double product = a * b;
  const Pair x = split(a);
  const Pair y = split(b);
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

constexpr Pair add(Pair a, Pair b) {
  const Pair high = two_sum(a.high, b.high);
  const Pair low = two_sum(a.low, b.low);
  const Pair sum = fast_two_sum(high.high, high.low + low.high);
  return fast_two_sum(sum.high, sum.low + low.low);
}

constexpr Pair negate(Pair a) { return {-a.high, -a.low}; }

constexpr Pair multiply(Pair a, Pair b) {
  const Pair product = two_product(a.high, b.high);
  return fast_two_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

constexpr Pair divide(Pair a, Pair b) {
  const double first = a.high / b.high;
  const Pair rest = add(a, negate(multiply(b, {first, 0})));
  const double second = rest.high / b.high;
  const Pair more = add(rest, negate(multiply(b, {second, 0})));
  return add(fast_two_sum(first, second), {more.high / b.high, 0});
}

// a / b to some 2^-75 of it, where the low parts may be as large as 2^-3 of the high ones.
constexpr Pair short_quotient(Pair a, Pair b) {
  const Pair over = fast_two_sum(a.high, a.low);
  const Pair under = fast_two_sum(b.high, b.low);
  const double first = over.high / under.high;
  const Pair product = two_product(first, under.high);
  const double rest = (over.high - product.high) - product.low + (over.low - first * under.low);
  return {first, rest / under.high};
}

constexpr double value_of(Pair a) { return a.high + a.low; }

// x + 1.5 * 2^52 has the whole number nearest to x in its low bits, for |x| < 2^50.
inline constexpr double kWholeNumbers = 0x1.8p+52;

inline constexpr Pair kLn2 = {0x1.62e42fefa39efp-1, 0x1.abc9e3b39803fp-56};
inline constexpr Pair kHalfPi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

}  // namespace stdlib
