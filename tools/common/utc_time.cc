#include "tools/common/utc_time.h"

#include <algorithm>
#include <chrono>
#include <cstdio>

namespace tools {
namespace {

constexpr std::string_view kForm = "dddd-dd-ddTdd:dd:ddZ";
constexpr size_t kDateSize = 10;
constexpr int64_t kDaySeconds = 86400;
constexpr int64_t kLastSecond = 253402300799;  // of the year 9999

bool has_form(std::string_view text) {
  if (text.size() != kDateSize && text.size() != kForm.size()) return false;
  return std::equal(text.begin(), text.end(), kForm.begin(), [](char c, char form) {
    return form == 'd' ? c >= '0' && c <= '9' : c == form;
  });
}

int number(std::string_view text, size_t at, size_t size) {
  int out = 0;
  for (size_t i = at; i < at + size; ++i) out = out * 10 + (text[i] - '0');
  return out;
}

}  // namespace

std::optional<int64_t> parse_utc(std::string_view text) {
  if (!has_form(text)) return std::nullopt;
  const std::chrono::year_month_day date{
      std::chrono::year(number(text, 0, 4)),
      std::chrono::month(static_cast<unsigned>(number(text, 5, 2))),
      std::chrono::day(static_cast<unsigned>(number(text, 8, 2)))};
  if (!date.ok() || number(text, 0, 4) < 1970) return std::nullopt;
  int64_t seconds = std::chrono::sys_days(date).time_since_epoch().count() * kDaySeconds;
  if (text.size() == kDateSize) return seconds;
  const int hour = number(text, 11, 2);
  const int minute = number(text, 14, 2);
  const int second = number(text, 17, 2);
  if (hour > 23 || minute > 59 || second > 59) return std::nullopt;
  return seconds + hour * 3600 + minute * 60 + second;
}

std::string utc_text(int64_t seconds) {
  if (seconds < 0 || seconds > kLastSecond) return std::to_string(seconds);
  const std::chrono::year_month_day date{
      std::chrono::sys_days(std::chrono::days(seconds / kDaySeconds))};
  const int in_day = static_cast<int>(seconds % kDaySeconds);
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02u-%02uT%02d:%02d:%02dZ", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                in_day / 3600, in_day / 60 % 60, in_day % 60);
  return text;
}

}  // namespace tools
