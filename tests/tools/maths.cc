// How far the own mathematics is from the truth, over as many random arguments as one has time for.
//
// usage: maths [COUNT [SEED]]   for each function; a million when none is given
//
// Ends with 1 when a function is farther away than its bound (tests/unit/stdlib/math_cases.h).
#include <cstdio>
#include <cstdlib>

#include "tests/unit/stdlib/math_cases.h"

int main(int count, char** words) {
  using namespace stdlib::testing;
  const uint64_t arguments = count > 1 ? std::strtoull(words[1], nullptr, 10) : 1000000;
  const uint64_t seed = count > 2 ? std::strtoull(words[2], nullptr, 10) : 0;
  bool right = arguments > 0;
  std::printf("%-24s %8s %7s   at\n", "function", "units", "bound");
  for (const MathCase& one : math_cases()) {
    Random random(seed);
    const Worst worst = one.worst(random, arguments);
    right = right && worst.error < one.bound;
    std::printf("%-24s %8.4f %7.2f   %a %a\n", one.name.c_str(), worst.error, one.bound, worst.x,
                worst.y);
    std::fflush(stdout);
  }
  return right ? 0 : 1;
}
