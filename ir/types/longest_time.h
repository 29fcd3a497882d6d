// The longest period, hold or watchdog: sums of it and the time since the start never overflow.
#pragma once

#include <cstdint>

namespace ir {

inline constexpr int64_t kLongestTimeNs = int64_t{366} * 86'400 * 1'000'000'000;

}  // namespace ir
