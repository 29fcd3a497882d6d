// The proleptic Gregorian calendar in int64 nanoseconds since
// 1970-01-01, by arithmetic alone: no time zone, no leap seconds, no tables.
#pragma once

#include <cstdint>

namespace stdlib {

inline constexpr uint64_t kNsPerSecond = 1'000'000'000;
inline constexpr uint64_t kNsPerMinute = 60 * kNsPerSecond;
inline constexpr uint64_t kNsPerHour = 60 * kNsPerMinute;
inline constexpr int64_t kNsPerDay = 24 * static_cast<int64_t>(kNsPerHour);

struct DayTime {
  int64_t days;       // since 1970-01-01
  int64_t ns_of_day;  // 0 .. kNsPerDay - 1
};

constexpr DayTime split_days(int64_t ns) {
  const int64_t below = ns % kNsPerDay < 0 ? 1 : 0;
  return {ns / kNsPerDay - below, ns % kNsPerDay + below * kNsPerDay};
}

struct CivilDate {
  int64_t year;
  uint32_t month;
  uint32_t day;
};

// Years start in March here, so that the leap day is the last of its year, and
// 400 years always have 146097 days.
constexpr CivilDate civil_from_days(int64_t days) {
  const int64_t shifted = days + 719'468;  // since 0000-03-01
  const int64_t era = (shifted >= 0 ? shifted : shifted - 146'096) / 146'097;
  const int64_t day_of_era = shifted - era * 146'097;
  const int64_t year_of_era =
      (day_of_era - day_of_era / 1'460 + day_of_era / 36'524 - day_of_era / 146'096) / 365;
  const int64_t day_of_year =
      day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const int64_t month = (5 * day_of_year + 2) / 153;  // from March = 0
  const auto day = static_cast<uint32_t>(day_of_year - (153 * month + 2) / 5 + 1);
  const auto civil_month = static_cast<uint32_t>(month < 10 ? month + 3 : month - 9);
  return {year_of_era + era * 400 + (civil_month <= 2 ? 1 : 0), civil_month, day};
}

}  // namespace stdlib
