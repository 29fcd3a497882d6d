// Points in time as people write them, always UTC: "2026-03-01" or "2026-03-01T08:00:00Z".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tools {

// Seconds since 1970; nullopt: no such time, or a year outside of 1970 to 9999.
std::optional<int64_t> parse_utc(std::string_view text);
// "2026-03-01T08:00:00Z"; a number where it is no year of four digits.
std::string utc_text(int64_t seconds);

}  // namespace tools
