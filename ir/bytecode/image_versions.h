// The versions of the stored form of an image. An image has the lowest one that says all of it, so
// older controllers take what they know.
#pragma once

#include <cstdint>

namespace ir {

inline constexpr uint32_t kFirstImageVersion = 7;
inline constexpr uint32_t kImageVersionOfSchedules = 8;
inline constexpr uint32_t kImageVersionOfCharts = 9;
inline constexpr uint32_t kImageVersionOfSources = 10;
inline constexpr uint32_t kLastImageVersion = kImageVersionOfSources;

}  // namespace ir
