// Ticks of a time axis: one, two or five of a power of ten.
#pragma once

#include <cstdint>
#include <string>

namespace stvm {

struct TimeScale {
  int64_t step_ns = 1;

  // At most `ticks` steps.
  static TimeScale of(int64_t end_ns, int64_t ticks);
  // In one unit for all of them: "250 us", "1000 us".
  std::string text(int64_t at_ns) const;
};

}  // namespace stvm
