// Values as IEC literals: what monitoring, fate reports and state texts print.
// Parsing them back is in value_parse.cc.
#include "ir/types/value_text.h"

#include <bit>
#include <charconv>
#include <chrono>
#include <cmath>

#include "ir/types/time_units.h"
#include "ir/types/utf.h"

namespace ir {
namespace {

uint64_t magnitude(int64_t value) {
  return value < 0 ? 0 - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
}

std::string digits(uint64_t value, size_t width) {
  std::string text = std::to_string(value);
  return text.size() < width ? std::string(width - text.size(), '0') + text : text;
}

std::string hex(uint64_t value, size_t width) {
  std::string text(width, '0');
  for (size_t i = width; i-- > 0; value >>= 4) {
    text[i] = "0123456789ABCDEF"[value & 15];
  }
  return text;
}

template <class Float>
std::string float_text(Float value) {
  if (std::isnan(value)) {
    return "NaN";
  }
  if (std::isinf(value)) {
    return value < 0 ? "-Inf" : "+Inf";
  }
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  std::string mantissa(buffer, end.ptr);
  std::string exponent;
  if (const size_t at = mantissa.find('e'); at != std::string::npos) {
    exponent = "E" + mantissa.substr(at + 1);
    mantissa.resize(at);
  }
  return mantissa + (mantissa.find('.') == std::string::npos ? ".0" : "") + exponent;
}

std::string date_text(int64_t days) {
  const std::chrono::year_month_day date{
      std::chrono::sys_days{std::chrono::days{static_cast<int32_t>(days)}}};
  return digits(static_cast<uint64_t>(static_cast<int>(date.year())), 4) + "-" +
         digits(static_cast<unsigned>(date.month()), 2) + "-" +
         digits(static_cast<unsigned>(date.day()), 2);
}

std::string clock_text(int64_t ns) {
  const uint64_t size = magnitude(ns);
  const uint64_t seconds = size / kNsPerSecond;
  std::string text = (ns < 0 ? "-" : "") + digits(seconds / 3600, 2) + ":" +
                     digits(seconds / 60 % 60, 2) + ":" + digits(seconds % 60, 2);
  if (const uint64_t fraction = size % kNsPerSecond; fraction != 0) {
    text += "." + digits(fraction, 9);
    text.resize(text.find_last_not_of('0') + 1);
  }
  return text;
}

int64_t floor_days(int64_t ns) { return ns / kNsPerDay - (ns % kNsPerDay < 0 ? 1 : 0); }

std::string date_and_time_text(int64_t ns) {
  const int64_t days = floor_days(ns);
  const int64_t of_day =
      static_cast<int64_t>(static_cast<uint64_t>(ns) - static_cast<uint64_t>(days) * kNsPerDay);
  return date_text(days) + "-" + clock_text(of_day);
}

std::string bit_string_text(Scalar scalar, uint64_t bits) {
  return "16#" + hex(bits, size_t{scalar_size(scalar)} * 2);
}

std::string char_text(Kind kind, uint64_t bits) {
  const char low = static_cast<char>(bits);
  const char high = static_cast<char>(bits >> 8);
  return kind == Kind::kChar ? string_text({&low, 1}) : wstring_text(std::string{low, high});
}

std::string date_group_text(Kind kind, int64_t ns) {
  switch (kind) {
    case Kind::kDate:
      return "D#" + date_text(floor_days(ns));
    case Kind::kLdate:
      return "LD#" + date_text(floor_days(ns));
    case Kind::kTod:
      return "TOD#" + clock_text(ns);
    case Kind::kLtod:
      return "LTOD#" + clock_text(ns);
    case Kind::kDt:
      return "DT#" + date_and_time_text(ns);
    default:
      return "LDT#" + date_and_time_text(ns);
  }
}

std::string elementary_text(Kind kind, Scalar scalar, uint64_t bits) {
  const int64_t value = static_cast<int64_t>(bits);
  switch (elementary_group(kind)) {
    case Group::kBit:
      return scalar == Scalar::kBool ? (bits != 0 ? "TRUE" : "FALSE")
                                     : bit_string_text(scalar, bits);
    case Group::kUnsigned:
      return std::to_string(bits);
    case Group::kReal:
      return scalar == Scalar::kF32 ? float_text(std::bit_cast<float>(static_cast<uint32_t>(bits)))
                                    : float_text(std::bit_cast<double>(bits));
    case Group::kDuration:
      return (kind == Kind::kLtime ? "L" : "") + duration_text(value);
    case Group::kDate:
      return date_group_text(kind, value);
    case Group::kChar:
      return char_text(kind, bits);
    default:
      return std::to_string(value);
  }
}

// `$` and the quote are escaped, and everything that a terminal may not show.
std::string escaped(uint32_t code, char quote, size_t hex_width) {
  switch (code) {
    case '\n':
      return "$L";
    case '\r':
      return "$R";
    case '\t':
      return "$T";
    case '\f':
      return "$P";
    case '$':
      return "$$";
    default:
      break;
  }
  if (code == static_cast<uint32_t>(quote)) {
    return std::string{'$', quote};
  }
  if (code >= 0x20 && code < 0x7f) {
    return std::string(1, static_cast<char>(code));
  }
  return "$" + hex(code, hex_width);
}

}  // namespace

std::string scalar_text(const TypeTable& types, TypeId type, uint64_t bits) {
  const Type& declared = types[type];
  if (declared.kind == Kind::kEnum) {
    for (const EnumLiteral& literal : declared.literals) {
      if (static_cast<uint64_t>(literal.value) == bits) {
        return literal.name;
      }
    }
  }
  if (declared.kind == Kind::kSubrange && types.contains(declared.base) &&
      types[declared.base].kind == Kind::kEnum) {
    return scalar_text(types, declared.base, bits);
  }
  if (is_reference(types.root_kind(type))) {
    return bits == 0 ? "NULL" : "ref";
  }
  return elementary_text(types.root_kind(type), types.scalar(type), bits);
}

std::string string_text(std::string_view bytes) {
  std::string text = "'";
  for (const char c : bytes) {
    text += escaped(static_cast<uint8_t>(c), '\'', 2);
  }
  return text + "'";
}

std::string wstring_text(std::string_view utf16le) {
  std::string text = "\"";
  for (size_t at = 0; at + 1 < utf16le.size();) {
    const Utf16Character character = read_utf16(utf16le.substr(at));
    at += size_t{character.units} * 2;
    const bool shown = character.valid && character.code >= 0xa0;
    text += shown ? utf8(character.code) : escaped(character.code, '"', 4);
  }
  return text + "\"";
}

std::string duration_text(int64_t ns) {
  if (ns == 0) {
    return "T#0s";
  }
  std::string text = ns < 0 ? "T#-" : "T#";
  uint64_t rest = magnitude(ns);
  for (const TimeUnit& unit : kTimeUnits) {
    if (const uint64_t count = rest / unit.ns; count != 0) {
      text += std::to_string(count) + std::string(unit.text);
      rest %= unit.ns;
    }
  }
  return text;
}

}  // namespace ir
