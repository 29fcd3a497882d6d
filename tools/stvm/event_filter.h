// Which events somebody wants to see.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"
#include "online_change/store/journal.h"

namespace stvm {

// "2026-03-01", "2026-03-01T08:00", "...:00:00", "...:00:00.123Z", in UTC, as times are shown: ns
// since 1970.
std::optional<int64_t> parse_time(const std::string& text);
// "90s", "10m", "1h30m", "2d": ns.
std::optional<int64_t> parse_age(std::string_view text);

struct EventFilter {
  int64_t since_ns = INT64_MIN;
  online_change::Level level = online_change::Level::kInfo;  // this one and those above it

  // The filter of the options --since and --level, "" where one is not given; kUsage.
  static base::Result<EventFilter> parse(const std::string& since, const std::string& level,
                                         int64_t now_ns);
  bool shows(const online_change::JournalEntry& entry) const {
    return entry.time_ns >= since_ns && event_row(entry.event).level <= level;
  }
};

}  // namespace stvm
