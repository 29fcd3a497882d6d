// The versions of the stored form of an image. An image has the lowest one that says all of it, so
// older controllers take what they know.
#pragma once

#include <cstdint>

namespace ir {

inline constexpr uint32_t kFirstImageVersion = 7;
inline constexpr uint32_t kImageVersionOfSchedules = 8;
inline constexpr uint32_t kImageVersionOfCharts = 9;
inline constexpr uint32_t kImageVersionOfSources = 10;
inline constexpr uint32_t kImageVersionOfContents = 11;
inline constexpr uint32_t kImageVersionOfContentsAndSources = 12;
// The version of images with code that holds what it does not name (image.h).
inline constexpr uint32_t kImageVersionOfHeld = 13;
inline constexpr uint32_t kImageVersionOfHeldAndSources = 14;
// The version of images that have tasks with a buffer of outputs, or an exchange of their own
// (task_policy.h).
inline constexpr uint32_t kImageVersionOfTaskExchange = 15;
inline constexpr uint32_t kImageVersionOfTaskExchangeAndSources = 16;
// The version of images with a migration from another type (LinkedMigration::from).
inline constexpr uint32_t kImageVersionOfOtherTypes = 17;
inline constexpr uint32_t kImageVersionOfOtherTypesAndSources = 18;
// The version of images with units that are not those of POUs (Image::unit_members).
inline constexpr uint32_t kImageVersionOfUnits = 19;
inline constexpr uint32_t kImageVersionOfUnitsAndSources = 20;
inline constexpr uint32_t kLastImageVersion = kImageVersionOfUnitsAndSources;

// From the first one with sources on, each even version has them, and the odd one before it not.
constexpr bool version_has_sources(uint32_t version) {
  return version >= kImageVersionOfSources && version % 2 == 0;
}

}  // namespace ir
