// Units of time in nanoseconds, and those of duration literals in the order in which they
// are written (IEC 61131-3 table 8).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ir {

inline constexpr int64_t kNsPerMicrosecond = 1'000;
inline constexpr int64_t kNsPerMillisecond = 1'000'000;
inline constexpr int64_t kNsPerSecond = 1'000'000'000;
inline constexpr int64_t kNsPerMinute = 60 * kNsPerSecond;
inline constexpr int64_t kNsPerHour = 60 * kNsPerMinute;
inline constexpr int64_t kNsPerDay = 24 * kNsPerHour;

struct TimeUnit {
  std::string_view text;
  uint64_t ns = 0;
};

inline constexpr std::array<TimeUnit, 7> kTimeUnits = {{
    {"d", kNsPerDay},
    {"h", kNsPerHour},
    {"m", kNsPerMinute},
    {"s", kNsPerSecond},
    {"ms", kNsPerMillisecond},
    {"us", kNsPerMicrosecond},
    {"ns", 1},
}};

}  // namespace ir
