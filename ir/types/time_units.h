// Units of duration literals in the order in which they are written (IEC 61131-3 table 8).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace ir {

struct TimeUnit {
  std::string_view text;
  uint64_t ns;
};

inline constexpr std::array<TimeUnit, 7> kTimeUnits = {{
    {"d", 86'400'000'000'000},
    {"h", 3'600'000'000'000},
    {"m", 60'000'000'000},
    {"s", 1'000'000'000},
    {"ms", 1'000'000},
    {"us", 1'000},
    {"ns", 1},
}};

}  // namespace ir
