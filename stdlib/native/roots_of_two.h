// 2^(i / 128), made by the compiler with twice the precision of double. `low` is what `high` leaves
// out, as a part of `high`.
#pragma once

#include <array>

#include "stdlib/native/double_double.h"

namespace stdlib {

// e^x for 0 <= x < 0.7, by its series.
constexpr Pair exponential_series(Pair x) {
  Pair sum = {1, 0};
  for (int32_t n = 30; n >= 1; --n) {
    sum = add({1, 0}, divide(multiply(x, sum), {static_cast<double>(n), 0}));
  }
  return sum;
}

constexpr std::array<Pair, 128> roots_of_two() {
  std::array<Pair, 128> roots = {};
  for (uint32_t i = 0; i < roots.size(); ++i) {
    const Pair root = exponential_series(multiply(kLn2, {i / 128.0, 0}));
    roots[i] = {root.high, root.low / root.high};
  }
  return roots;
}

inline constexpr std::array<Pair, 128> kRootsOfTwo = roots_of_two();

}  // namespace stdlib
