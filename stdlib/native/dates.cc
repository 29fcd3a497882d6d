// Moments put together from their parts and taken apart (IEC 61131-3 tables 35 and 36).
#include <limits>

#include "stdlib/native/calendar.h"
#include "stdlib/native/implementation.h"

namespace stdlib {
namespace {

constexpr int64_t kNoMoment = std::numeric_limits<int64_t>::min();

bool within(int64_t value, int64_t most) { return value >= 0 && value <= most; }

int64_t moment(int64_t year, int64_t month, int64_t day, int64_t hour, int64_t minute,
               int64_t second, int64_t millisecond) {
  const std::optional<int64_t> days = days_from_civil(year, month, day);
  const bool clock =
      within(hour, 23) && within(minute, 59) && within(second, 59) && within(millisecond, 999);
  int64_t ns = 0;
  if (!days || !clock || __builtin_mul_overflow(*days, ir::kNsPerDay, &ns)) {
    return kNoMoment;
  }
  const int64_t of_day = hour * ir::kNsPerHour + minute * ir::kNsPerMinute +
                         second * ir::kNsPerSecond + millisecond * ir::kNsPerMillisecond;
  return __builtin_add_overflow(ns, of_day, &ns) ? kNoMoment : ns;
}

int64_t part_of(int64_t ns, int32_t part) {
  const DayTime at = split_days(ns);
  const CivilDate date = civil_from_days(at.days);
  switch (part & 0xFF) {
    case 0:
      return date.year;
    case 1:
      return date.month;
    case 2:
      return date.day;
    case 3:
      return at.ns_of_day / ir::kNsPerHour;
    case 4:
      return at.ns_of_day / ir::kNsPerMinute % 60;
    case 5:
      return at.ns_of_day / ir::kNsPerSecond % 60;
    case 6:
      return at.ns_of_day / ir::kNsPerMillisecond % 1000;
    default:  // the first day of 1970 was a Thursday
      return ((at.days + 4) % 7 + 7) % 7;
  }
}

int32_t moment_part(int64_t ns, int32_t part) { return static_cast<int32_t>(part_of(ns, part)); }

}  // namespace

STC_NATIVE(kMoment, moment)
STC_NATIVE(kMomentPart, moment_part)

}  // namespace stdlib
