#include "ir/types/time_parse.h"

#include <chrono>
#include <initializer_list>
#include <limits>

#include "ir/types/time_units.h"

namespace ir {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// A cursor over the literal; every reader moves it only when it succeeds.
struct Cursor {
  std::string_view rest;

  bool take(char c) {
    if (rest.empty() || rest[0] != c) {
      return false;
    }
    rest.remove_prefix(1);
    return true;
  }

  std::optional<uint64_t> number() {
    uint64_t value = 0;
    size_t at = 0;
    for (; at < rest.size() && (is_digit(rest[at]) || (at != 0 && rest[at] == '_')); ++at) {
      if (rest[at] == '_') continue;
      const uint64_t digit = static_cast<uint64_t>(rest[at] - '0');
      if (value > (std::numeric_limits<uint64_t>::max() - digit) / 10) return std::nullopt;
      value = value * 10 + digit;
    }
    if (at == 0) return std::nullopt;
    rest.remove_prefix(at);
    return value;
  }

  // Digits after a point as parts of `unit_ns`; further digits than it can show are dropped.
  uint64_t fraction(uint64_t unit_ns) {
    uint64_t value = 0;
    uint64_t weight = unit_ns;
    uint64_t scale = 1;
    while (!rest.empty() && (is_digit(rest[0]) || rest[0] == '_')) {
      if (rest[0] != '_' && scale <= 1'000'000'000'000'000) {
        scale *= 10;
        value = value * 10 + static_cast<uint64_t>(rest[0] - '0');
      }
      rest.remove_prefix(1);
    }
    return static_cast<uint64_t>(static_cast<unsigned __int128>(value) * weight / scale);
  }

  const TimeUnit* unit() {
    size_t length = 0;
    while (length < rest.size() && !is_digit(rest[length]) && rest[length] != '_') ++length;
    for (const TimeUnit& unit : kTimeUnits) {
      if (same_name(rest.substr(0, length), unit.text)) {
        rest.remove_prefix(length);
        return &unit;
      }
    }
    return nullptr;
  }
};

// The text after "T#" and the like; the text itself when it has no prefix at all.
std::optional<std::string_view> behind_prefix(std::string_view text,
                                              std::initializer_list<std::string_view> prefixes) {
  const size_t hash = text.find('#');
  if (hash == std::string_view::npos) {
    return text;
  }
  for (const std::string_view prefix : prefixes) {
    if (same_name(text.substr(0, hash), prefix)) {
      return text.substr(hash + 1);
    }
  }
  return std::nullopt;
}

struct DurationPart {
  uint64_t ns = 0;
  const TimeUnit* unit = nullptr;
  bool last = false;  // only the smallest unit may have a fraction
};

// The fraction stands before its unit, so the unit is found first on a copy.
std::optional<DurationPart> parse_part(Cursor& cursor) {
  const std::optional<uint64_t> whole = cursor.number();
  if (!whole) return std::nullopt;
  DurationPart part;
  Cursor digits = cursor;
  if (cursor.take('.')) {
    part.last = true;
    if (cursor.rest.empty() || !is_digit(cursor.rest[0])) return std::nullopt;
    digits = cursor;
    cursor.fraction(1);
  }
  part.unit = cursor.unit();
  if (part.unit == nullptr) return std::nullopt;
  const auto total = static_cast<unsigned __int128>(*whole) * part.unit->ns +
                     (part.last ? digits.fraction(part.unit->ns) : 0);
  if (total > uint64_t{1} << 63) return std::nullopt;
  part.ns = static_cast<uint64_t>(total);
  return part;
}

std::optional<uint64_t> parse_parts(Cursor cursor) {
  uint64_t sum = 0;
  const TimeUnit* previous = nullptr;
  do {
    const std::optional<DurationPart> part = parse_part(cursor);
    if (!part || (previous != nullptr && part->unit <= previous)) return std::nullopt;
    sum += part->ns;
    if (sum > uint64_t{1} << 63) return std::nullopt;
    if (part->last && !cursor.rest.empty()) return std::nullopt;
    previous = part->unit;
    cursor.take('_');
  } while (!cursor.rest.empty());
  return sum;
}

std::optional<int64_t> parse_day(Cursor& cursor) {
  const std::optional<uint64_t> year = cursor.number();
  if (!year || *year > 9999 || !cursor.take('-')) return std::nullopt;
  const std::optional<uint64_t> month = cursor.number();
  if (!month || *month > 12 || !cursor.take('-')) return std::nullopt;
  const std::optional<uint64_t> day = cursor.number();
  if (!day || *day > 31) return std::nullopt;
  const std::chrono::year_month_day date{std::chrono::year(static_cast<int>(*year)),
                                         std::chrono::month(static_cast<unsigned>(*month)),
                                         std::chrono::day(static_cast<unsigned>(*day))};
  if (!date.ok()) return std::nullopt;
  return std::chrono::sys_days(date).time_since_epoch().count();
}

// hours:minutes[:seconds[.fraction]]
std::optional<int64_t> parse_clock(Cursor& cursor) {
  const std::optional<uint64_t> hours = cursor.number();
  if (!hours || *hours > 23 || !cursor.take(':')) return std::nullopt;
  const std::optional<uint64_t> minutes = cursor.number();
  if (!minutes || *minutes > 59) return std::nullopt;
  uint64_t ns = (*hours * 3600 + *minutes * 60) * kNsPerSecond;
  if (cursor.take(':')) {
    const std::optional<uint64_t> seconds = cursor.number();
    if (!seconds || *seconds > 59) return std::nullopt;
    ns += *seconds * kNsPerSecond;
    if (cursor.take('.')) ns += cursor.fraction(kNsPerSecond);
  }
  return static_cast<int64_t>(ns);
}

std::optional<int64_t> to_ns(int64_t days, int64_t ns_of_day) {
  const __int128 ns = static_cast<__int128>(days) * kNsPerDay + ns_of_day;
  if (ns < std::numeric_limits<int64_t>::min() || ns > std::numeric_limits<int64_t>::max()) {
    return std::nullopt;
  }
  return static_cast<int64_t>(ns);
}

std::optional<int64_t> parse_date_and_time(Cursor& cursor) {
  const std::optional<int64_t> days = parse_day(cursor);
  if (!days || !cursor.take('-')) return std::nullopt;
  const std::optional<int64_t> clock = parse_clock(cursor);
  return clock ? to_ns(*days, *clock) : std::nullopt;
}

std::optional<std::string_view> behind_date_prefix(Kind kind, std::string_view text) {
  switch (kind) {
    case Kind::kDate:
    case Kind::kLdate:
      return behind_prefix(text, {"D", "DATE", "LD", "LDATE"});
    case Kind::kTod:
    case Kind::kLtod:
      return behind_prefix(text, {"TOD", "TIME_OF_DAY", "LTOD", "LTIME_OF_DAY"});
    default:
      return behind_prefix(text, {"DT", "DATE_AND_TIME", "LDT", "LDATE_AND_TIME"});
  }
}

}  // namespace

std::optional<int64_t> parse_duration(std::string_view text) {
  const std::optional<std::string_view> body = behind_prefix(text, {"T", "TIME", "LT", "LTIME"});
  if (!body) return std::nullopt;
  Cursor cursor{*body};
  const bool negative = cursor.take('-');
  if (!negative) cursor.take('+');
  const std::optional<uint64_t> size = parse_parts(cursor);
  if (!size || (!negative && *size == uint64_t{1} << 63)) return std::nullopt;
  return static_cast<int64_t>(negative ? 0 - *size : *size);
}

std::optional<int64_t> parse_date(Kind kind, std::string_view text) {
  const std::optional<std::string_view> body = behind_date_prefix(kind, text);
  if (!body) return std::nullopt;
  Cursor cursor{*body};
  std::optional<int64_t> ns;
  if (kind == Kind::kDate || kind == Kind::kLdate) {
    const std::optional<int64_t> days = parse_day(cursor);
    ns = days ? to_ns(*days, 0) : std::nullopt;
  } else if (kind == Kind::kTod || kind == Kind::kLtod) {
    ns = parse_clock(cursor);
  } else {
    ns = parse_date_and_time(cursor);
  }
  return cursor.rest.empty() ? ns : std::nullopt;
}

}  // namespace ir
