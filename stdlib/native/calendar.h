// The proleptic Gregorian calendar in int64 nanoseconds since
// 1970-01-01, by arithmetic alone: no time zone, no leap seconds, no tables.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/types/time_units.h"

namespace stdlib {

struct DayTime {
  int64_t days;       // since 1970-01-01
  int64_t ns_of_day;  // 0 .. ir::kNsPerDay - 1
};

constexpr DayTime split_days(int64_t ns) {
  const int64_t below = ns % ir::kNsPerDay < 0 ? 1 : 0;
  return {ns / ir::kNsPerDay - below, ns % ir::kNsPerDay + below * ir::kNsPerDay};
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

// The other way; nullopt when there is no such day.
constexpr std::optional<int64_t> days_from_civil(int64_t year, int64_t month, int64_t day) {
  if (year < 1 || year > 9999 || month < 1 || month > 12 || day < 1 || day > 31) {
    return std::nullopt;
  }
  const int64_t march_year = month <= 2 ? year - 1 : year;
  const int64_t month_from_march = month <= 2 ? month + 9 : month - 3;
  const int64_t day_of_year = (153 * month_from_march + 2) / 5 + day - 1;
  const int64_t days = march_year * 365 + march_year / 4 - march_year / 100 + march_year / 400 +
                       day_of_year - 719'468;
  const CivilDate back = civil_from_days(days);  // the 30th of February is another day
  return back.month == month && back.day == day ? std::optional(days) : std::nullopt;
}

}  // namespace stdlib
