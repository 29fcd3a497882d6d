// Numbers, durations and dates as STRING, spelled like ir/types/value_text.h.
// Longer results than the destination can hold are truncated by Sink.
#include <array>
#include <charconv>
#include <cmath>

#include "ir/types/time_units.h"
#include "stdlib/native/calendar.h"
#include "stdlib/native/implementation.h"
#include "stdlib/native/text.h"

namespace stdlib {
namespace {

// Longer than any number, duration or date.
class Line {
 public:
  std::string_view text() const { return {buffer_.data(), used_}; }

  Line& operator<<(std::string_view text) {
    for (const char character : text) {
      push(character);
    }
    return *this;
  }
  template <typename Number>
  Line& number(Number value) {
    const auto end = std::to_chars(buffer_.data() + used_, buffer_.data() + buffer_.size(), value);
    used_ = static_cast<size_t>(end.ptr - buffer_.data());
    return *this;
  }
  // At least `width` digits, with zeros in front.
  Line& digits(uint64_t value, int width) {
    uint64_t power = 1;
    for (int i = 1; i < width || value / power >= 10; ++i) {
      power *= 10;
    }
    for (; power != 0; power /= 10) {
      push(static_cast<char>('0' + value / power % 10));
    }
    return *this;
  }
  void drop_trailing_zeros() {
    while (used_ != 0 && buffer_[used_ - 1] == '0') {
      --used_;
    }
  }

 private:
  void push(char character) {
    if (used_ < buffer_.size()) {
      buffer_[used_++] = character;
    }
  }

  std::array<char, 96> buffer_{};
  size_t used_ = 0;
};

uint64_t magnitude(int64_t value) {
  return value < 0 ? 0 - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
}

// IEC real literals have a point and a capital E: 2.0, 1.0E+10.
template <typename Float>
void float_to_string(String to, Float value) {
  if (!std::isfinite(value)) {
    return put_text(to, std::isnan(value) ? "NaN" : value < 0 ? "-Inf" : "+Inf");
  }
  Line digits;
  const std::string_view shortest = digits.number(value).text();
  const size_t exponent = std::min(shortest.find('e'), shortest.size());
  const std::string_view mantissa = shortest.substr(0, exponent);
  Line line;
  line << mantissa << (mantissa.find('.') == std::string_view::npos ? ".0" : "");
  if (exponent < shortest.size()) {
    line << "E" << shortest.substr(exponent + 1);
  }
  put_text(to, line.text());
}

void put_clock(Line& line, uint64_t ns) {
  constexpr auto kSecond = static_cast<uint64_t>(ir::kNsPerSecond);
  line.digits(ns / (3600 * kSecond), 2) << ":";
  line.digits(ns / (60 * kSecond) % 60, 2) << ":";
  line.digits(ns / kSecond % 60, 2);
  if (const uint64_t fraction = ns % kSecond; fraction != 0) {
    (line << ".").digits(fraction, 9).drop_trailing_zeros();
  }
}

void put_day(Line& line, int64_t days) {
  const CivilDate date = civil_from_days(days);
  line.number(date.year) << "-";
  line.digits(date.month, 2) << "-";
  line.digits(date.day, 2);
}

constexpr std::array<char, 200> kPairs = [] {
  std::array<char, 200> pairs{};
  for (size_t i = 0; i < 100; ++i) {
    pairs[2 * i] = static_cast<char>('0' + i / 10);
    pairs[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return pairs;
}();

// Two digits at a time, from the last one on.
void put_integer(String destination, uint64_t size, bool minus) {
  constexpr size_t kMost = 21;
  std::array<char, kMost> buffer;
  size_t at = kMost;
  for (; size >= 100; size /= 100) {
    at -= 2;
    std::memcpy(&buffer[at], &kPairs[2 * (size % 100)], 2);
  }
  if (size >= 10) {
    at -= 2;
    std::memcpy(&buffer[at], &kPairs[2 * size], 2);
  } else {
    buffer[--at] = static_cast<char>('0' + size);
  }
  if (minus) buffer[--at] = '-';
  put_text(destination, {&buffer[at], kMost - at});
}

void i64_to_string(String to, int64_t value) { put_integer(to, magnitude(value), value < 0); }
void u64_to_string(String to, uint64_t value) { put_integer(to, value, false); }

void bool_to_string(String to, bool value) { put_text(to, value ? "TRUE" : "FALSE"); }

void time_to_string(String to, int64_t ns, bool is_long) {
  Line line;
  line << (is_long ? "LT#" : "T#") << (ns < 0 ? "-" : "");
  uint64_t rest = magnitude(ns);
  if (rest == 0) {
    line << (is_long ? "0ns" : "0ms");
  }
  for (const ir::TimeUnit& unit : ir::kTimeUnits) {
    if (rest >= unit.ns) {
      line.number(rest / unit.ns) << unit.text;
      rest %= unit.ns;
    }
  }
  put_text(to, line.text());
}

void date_to_string(String to, int64_t ns, bool is_long) {
  Line line;
  put_day(line << (is_long ? "LD#" : "D#"), split_days(ns).days);
  put_text(to, line.text());
}

void tod_to_string(String to, int64_t ns, bool is_long) {
  Line line;
  line << (is_long ? "LTOD#" : "TOD#") << (ns < 0 ? "-" : "");
  put_clock(line, magnitude(ns));
  put_text(to, line.text());
}

void dt_to_string(String to, int64_t ns, bool is_long) {
  const DayTime moment = split_days(ns);
  Line line;
  put_day(line << (is_long ? "LDT#" : "DT#"), moment.days);
  put_clock(line << "-", static_cast<uint64_t>(moment.ns_of_day));
  put_text(to, line.text());
}

void char_to_string(String to, uint64_t code) {
  Sink sink(to);
  if (code != 0) {
    sink.put(code <= 0xFF ? static_cast<uint8_t>(code) : uint8_t{'?'});
  }
}

void char_to_wstring(Wstring to, uint64_t code) {
  Sink sink(to);
  if (code != 0) {
    sink.put(static_cast<uint16_t>(code));
  }
}

}  // namespace

STC_NATIVE(kI64ToString, i64_to_string)
STC_NATIVE(kU64ToString, u64_to_string)
STC_NATIVE(kF32ToString, float_to_string<float>)
STC_NATIVE(kF64ToString, float_to_string<double>)
STC_NATIVE(kBoolToString, bool_to_string)
STC_NATIVE(kTimeToString, time_to_string)
STC_NATIVE(kDateToString, date_to_string)
STC_NATIVE(kTodToString, tod_to_string)
STC_NATIVE(kDtToString, dt_to_string)
STC_NATIVE(kCharToString, char_to_string)
STC_NATIVE(kCharToWstring, char_to_wstring)

}  // namespace stdlib
