#include "tools/stvm/event_filter.h"

#include <charconv>
#include <ctime>

#include "tools/stvm/event_text.h"

namespace stvm {
namespace {

using online_change::Level;

constexpr int64_t kNsInSecond = 1'000'000'000;
constexpr int64_t kLongestAgeS = int64_t{200} * 365 * 86'400;

int64_t seconds_of(char unit) {
  switch (unit) {
    case 's':
      return 1;
    case 'm':
      return 60;
    case 'h':
      return 3'600;
    case 'd':
      return 86'400;
    default:
      return 0;
  }
}

// ".123" and its like, cut away: ns. nullopt: it is something else.
std::optional<int64_t> take_fraction(std::string& text) {
  const size_t dot = text.find('.');
  if (dot == std::string::npos) return 0;
  std::string digits = text.substr(dot + 1);
  if (digits.empty() || digits.size() > 9) return std::nullopt;
  if (digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  digits.resize(9, '0');
  text.resize(dot);
  return std::stoll(digits);
}

}  // namespace

std::optional<int64_t> parse_time(const std::string& given) {
  std::string text = given;
  if (!text.empty() && text.back() == 'Z') text.pop_back();
  const std::optional<int64_t> fraction = take_fraction(text);
  if (!fraction) return std::nullopt;
  for (const char* form : {"%Y-%m-%dT%H:%M:%S", "%Y-%m-%dT%H:%M", "%Y-%m-%d"}) {
    std::tm parts{};
    const char* const end = ::strptime(text.c_str(), form, &parts);
    if (end == nullptr || *end != '\0') continue;
    const bool shown = parts.tm_year >= 70 && parts.tm_year < 300;  // more ns have no room
    if (!shown) return std::nullopt;
    return static_cast<int64_t>(::timegm(&parts)) * kNsInSecond + *fraction;
  }
  return std::nullopt;
}

std::optional<int64_t> parse_age(std::string_view text) {
  int64_t seconds = 0;
  if (text.empty()) return std::nullopt;
  while (!text.empty()) {
    int64_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    const auto digits = static_cast<size_t>(end - text.data());
    if (error != std::errc() || count < 0 || digits == text.size()) return std::nullopt;
    const int64_t unit = seconds_of(*end);
    if (unit == 0 || count > kLongestAgeS / unit) return std::nullopt;
    seconds += count * unit;
    if (seconds > kLongestAgeS) return std::nullopt;
    text.remove_prefix(digits + 1);
  }
  return seconds * kNsInSecond;
}

base::Result<EventFilter> EventFilter::parse(const std::string& since, const std::string& level,
                                             int64_t now_ns) {
  EventFilter out;
  for (const Level one : {Level::kError, Level::kWarning, Level::kNotice}) {
    if (level == level_name(one)) out.level = one;
  }
  if (since.empty()) return out;
  if (const std::optional<int64_t> time = parse_time(since)) {
    out.since_ns = *time;
  } else if (const std::optional<int64_t> age = parse_age(since)) {
    out.since_ns = now_ns - *age;
  } else {
    return base::Error{base::Refusal::kUsage,
                       "--since " + since +
                           ": expected a time in UTC as 2026-03-01T08:00:00 or 2026-03-01, or how "
                           "long ago: 90s, 10m, 1h30m, 2d"};
  }
  return out;
}

}  // namespace stvm
