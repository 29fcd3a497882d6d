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
uint64_t put_float(const NativeArg& destination, Float value) {
  if (!std::isfinite(value)) {
    put_text(destination, std::isnan(value) ? "NaN" : value < 0 ? "-Inf" : "+Inf");
    return 0;
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
  put_text(destination, line.text());
  return 0;
}

bool is_long(const NativeArg* args) { return (args[2].bits & 0xFF) != 0; }

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

}  // namespace

template <>
uint64_t native<NativeId::kI64ToString>(NativeArg* args) {
  put_text(args[0], Line().number(int_of(args[1])).text());
  return 0;
}

template <>
uint64_t native<NativeId::kU64ToString>(NativeArg* args) {
  put_text(args[0], Line().number(args[1].bits).text());
  return 0;
}

template <>
uint64_t native<NativeId::kF32ToString>(NativeArg* args) {
  return put_float(args[0], float_of(args[1]));
}

template <>
uint64_t native<NativeId::kF64ToString>(NativeArg* args) {
  return put_float(args[0], double_of(args[1]));
}

template <>
uint64_t native<NativeId::kBoolToString>(NativeArg* args) {
  put_text(args[0], (args[1].bits & 0xFF) != 0 ? "TRUE" : "FALSE");
  return 0;
}

template <>
uint64_t native<NativeId::kTimeToString>(NativeArg* args) {
  Line line;
  line << (is_long(args) ? "LT#" : "T#") << (int_of(args[1]) < 0 ? "-" : "");
  uint64_t rest = magnitude(int_of(args[1]));
  if (rest == 0) {
    line << (is_long(args) ? "0ns" : "0ms");
  }
  for (const ir::TimeUnit& unit : ir::kTimeUnits) {
    if (rest >= unit.ns) {
      line.number(rest / unit.ns) << unit.text;
      rest %= unit.ns;
    }
  }
  put_text(args[0], line.text());
  return 0;
}

template <>
uint64_t native<NativeId::kDateToString>(NativeArg* args) {
  Line line;
  put_day(line << (is_long(args) ? "LD#" : "D#"), split_days(int_of(args[1])).days);
  put_text(args[0], line.text());
  return 0;
}

template <>
uint64_t native<NativeId::kTodToString>(NativeArg* args) {
  Line line;
  line << (is_long(args) ? "LTOD#" : "TOD#") << (int_of(args[1]) < 0 ? "-" : "");
  put_clock(line, magnitude(int_of(args[1])));
  put_text(args[0], line.text());
  return 0;
}

template <>
uint64_t native<NativeId::kDtToString>(NativeArg* args) {
  const DayTime moment = split_days(int_of(args[1]));
  Line line;
  put_day(line << (is_long(args) ? "LDT#" : "DT#"), moment.days);
  put_clock(line << "-", static_cast<uint64_t>(moment.ns_of_day));
  put_text(args[0], line.text());
  return 0;
}

template <>
uint64_t native<NativeId::kCharToString>(NativeArg* args) {
  Sink<uint8_t> sink(args[0]);
  const uint64_t code = args[1].bits;
  if (code != 0) {
    sink.put(code <= 0xFF ? static_cast<uint8_t>(code) : uint8_t{'?'});
  }
  return 0;
}

template <>
uint64_t native<NativeId::kCharToWstring>(NativeArg* args) {
  Sink<uint16_t> sink(args[0]);
  if (args[1].bits != 0) {
    sink.put(static_cast<uint16_t>(args[1].bits));
  }
  return 0;
}

}  // namespace stdlib
