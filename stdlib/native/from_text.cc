// STRING to numbers and durations. Whatever the text is, there is a result: 0
// or FALSE when it is none, the nearest end of the range when it is too large.
#include <charconv>
#include <limits>
#include <optional>

#include "ir/types/time_parse.h"
#include "stdlib/native/implementation.h"
#include "stdlib/native/text.h"

namespace stdlib {
namespace {

bool is_digit(char character) { return character >= '0' && character <= '9'; }

char upper(char character) {
  return character >= 'a' && character <= 'z' ? static_cast<char>(character - 'a' + 'A')
                                              : character;
}

bool starts_with_folded(std::string_view text, std::string_view prefix) {
  return text.size() >= prefix.size() &&
         std::equal(prefix.begin(), prefix.end(), text.begin(),
                    [](char a, char b) { return upper(a) == upper(b); });
}

bool take(std::string_view& text, std::string_view prefix) {
  if (!starts_with_folded(text, prefix)) {
    return false;
  }
  text.remove_prefix(prefix.size());
  return true;
}

// A sign in front; a plus is removed, a minus too.
bool take_minus(std::string_view& text) {
  if (text.empty() || (text[0] != '-' && text[0] != '+')) return false;
  const bool minus = text[0] == '-';
  text.remove_prefix(1);
  return minus;
}

// The value of a digit; 16 when it is none.
uint64_t digit_of(char character) {
  if (is_digit(character)) {
    return static_cast<uint64_t>(character - '0');
  }
  const char letter = upper(character);
  return letter >= 'A' && letter <= 'F' ? static_cast<uint64_t>(letter - 'A' + 10) : 16;
}

// The digits in front, of the base that stands before them; saturates.
uint64_t leading_number(std::string_view text) {
  const uint64_t base = take(text, "16#") ? 16 : take(text, "8#") ? 8 : take(text, "2#") ? 2 : 10;
  uint64_t value = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '_' && i != 0) {
      continue;
    }
    const uint64_t digit = digit_of(text[i]);
    if (digit >= base) {
      break;
    }
    if (__builtin_mul_overflow(value, base, &value) ||
        __builtin_add_overflow(value, digit, &value)) {
      return std::numeric_limits<uint64_t>::max();
    }
  }
  return value;
}

// 10 to which power is the leading digit of a number that no double can hold?
// Only its sign is used: too large or too small.
int64_t decimal_magnitude(std::string_view text) {
  int64_t magnitude = 0;
  bool leading = true;
  bool fraction = false;
  size_t i = 0;
  for (; i < text.size() && (is_digit(text[i]) || text[i] == '.'); ++i) {
    if (text[i] == '.') {
      fraction = true;
    } else if (leading && text[i] == '0') {
      magnitude -= fraction ? 1 : 0;
    } else {
      magnitude += fraction ? 0 : 1;
      leading = false;
    }
  }
  if (i >= text.size() || upper(text[i]) != 'E') {
    return magnitude;
  }
  std::string_view exponent = text.substr(i + 1);
  const bool minus = take_minus(exponent);
  const auto size =
      static_cast<int64_t>(std::min<uint64_t>(leading_number(exponent), uint64_t{1} << 40));
  return magnitude + (minus ? -size : size);
}

// Begins with a digit, or a point and a digit.
double leading_real(std::string_view text) {
  char plain[400];  // without `_`
  if (text.find('_') != std::string_view::npos) {
    size_t size = 0;
    for (const char character : text.substr(0, sizeof plain)) {
      if (character != '_') {
        plain[size++] = character;
      }
    }
    text = {plain, size};
  }
  double value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec == std::errc::result_out_of_range) {
    return decimal_magnitude(text) > 0 ? std::numeric_limits<double>::infinity() : 0;
  }
  return end.ec == std::errc() ? value : 0;
}

// Nothing but a sign and a few decimal digits in front of the end: no overflow, no base, no `_`.
std::optional<uint64_t> plain_number(std::string_view digits) {
  constexpr size_t kMost = 19;
  if (digits.size() > kMost) return std::nullopt;
  uint64_t value = 0;
  for (const char digit : digits) {
    if (!is_digit(digit)) return std::nullopt;
    value = value * 10 + static_cast<uint64_t>(digit - '0');
  }
  return value;
}

uint64_t number_in_front(std::string_view text) {
  const std::optional<uint64_t> plain = plain_number(text);
  return plain ? *plain : leading_number(text);
}

int64_t string_to_i64(String from) {
  std::string_view text = without_leading_spaces(text_of(from));
  const bool minus = take_minus(text);
  const uint64_t limit = (uint64_t{1} << 63) - (minus ? 0 : 1);
  const uint64_t size = std::min(number_in_front(text), limit);
  return static_cast<int64_t>(minus ? 0 - size : size);
}

uint64_t string_to_u64(String from) {
  std::string_view text = without_leading_spaces(text_of(from));
  take(text, "+");
  return number_in_front(text);
}

double string_to_f64(String from) {
  std::string_view text = without_leading_spaces(text_of(from));
  const bool minus = take_minus(text);
  const bool point = text.starts_with('.');
  double size = 0;
  if (text.size() > point && is_digit(text[point])) {
    const bool based = text.substr(0, 3).find('#') != std::string_view::npos;
    size = based ? static_cast<double>(leading_number(text)) : leading_real(text);
  } else {  // the words of *_TO_STRING, or no number
    const std::string_view word = trimmed(text);
    if (word != "Inf") {
      return word == "NaN" ? std::numeric_limits<double>::quiet_NaN() : 0;
    }
    size = std::numeric_limits<double>::infinity();
  }
  return minus ? -size : size;
}

bool string_to_bool(String from) {
  const std::string_view text = trimmed(text_of(from));
  return text == "1" || (text.size() == 4 && starts_with_folded(text, "TRUE"));
}

int64_t string_to_time(String from) {
  return ir::parse_duration(trimmed(text_of(from))).value_or(0);
}

int64_t string_to_date(String from, int32_t number) {
  const auto kind = static_cast<ir::Kind>(number & 0xFF);
  return ir::parse_date(kind, trimmed(text_of(from))).value_or(0);
}

template <typename Unit>
int32_t first_character(Text<Unit> text) {
  return text.capacity == 0 ? 0 : load<Unit>(text.data);
}

}  // namespace

STC_NATIVE(kStringToI64, string_to_i64)
STC_NATIVE(kStringToU64, string_to_u64)
STC_NATIVE(kStringToF64, string_to_f64)
STC_NATIVE(kStringToBool, string_to_bool)
STC_NATIVE(kStringToTime, string_to_time)
STC_NATIVE(kStringToDate, string_to_date)
STC_NATIVE(kStringToChar, first_character<uint8_t>)
STC_NATIVE(kWstringToChar, first_character<uint16_t>)

}  // namespace stdlib
