// Does work grow with its size, and not with its square? Told by processor time of this process on
// two sizes in turn, the larger four times the smaller: a ratio, which other load, a slow machine
// and sanitizers leave as it is. One good pair of several is enough.
#pragma once

#include <ctime>

namespace tests {

inline double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// `seconds_for(size)` does the work and says its processor time. A square would give 16.
template <class SecondsFor>
bool grows_linearly(SecondsFor seconds_for, int size) {
  constexpr int kTries = 7;
  constexpr double kMost = 9.0;
  for (int i = 0; i < kTries; ++i) {
    const double small = seconds_for(size / 4);
    if (seconds_for(size) < kMost * small) return true;
  }
  return false;
}

}  // namespace tests
