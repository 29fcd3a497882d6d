// Moments put together from their parts and taken apart (IEC 61131-3 tables 35 and 36).
#include <limits>

#include "stdlib/native/calendar.h"
#include "stdlib/native/implementation.h"

namespace stdlib {
namespace {

constexpr int64_t kNoMoment = std::numeric_limits<int64_t>::min();

bool within(int64_t value, int64_t most) { return value >= 0 && value <= most; }

int64_t moment(const NativeArg* args) {
  const std::optional<int64_t> days =
      days_from_civil(int_of(args[0]), int_of(args[1]), int_of(args[2]));
  const int64_t hour = int_of(args[3]);
  const int64_t minute = int_of(args[4]);
  const int64_t second = int_of(args[5]);
  const int64_t millisecond = int_of(args[6]);
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

int64_t part_of(int64_t ns, uint64_t part) {
  const DayTime at = split_days(ns);
  const CivilDate date = civil_from_days(at.days);
  switch (part) {
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

}  // namespace

template <>
uint64_t native<NativeId::kMoment>(NativeArg* args) {
  return bits_of(moment(args));
}

template <>
uint64_t native<NativeId::kMomentPart>(NativeArg* args) {
  return bits_of(part_of(int_of(args[0]), args[1].bits & 0xFF));
}

}  // namespace stdlib
