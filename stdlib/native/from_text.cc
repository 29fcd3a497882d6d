// STRING to numbers and durations. Whatever the text is, there is a result: 0
// or FALSE when it is none, the nearest end of the range when it is too large.
#include <charconv>
#include <limits>
#include <optional>

#include "ir/types/time_units.h"
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
bool take_minus(std::string_view& text) { return take(text, "-") || (take(text, "+"), false); }

// The digits in front; saturates.
uint64_t leading_number(std::string_view text) {
  uint64_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  return end.ec == std::errc::result_out_of_range ? std::numeric_limits<uint64_t>::max() : value;
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

double leading_real(std::string_view text) {
  const bool number = !text.empty() && (is_digit(text[0]) || text[0] == '.');
  double value = 0;
  if (!number) {
    return value;
  }
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec == std::errc::result_out_of_range) {
    return decimal_magnitude(text) > 0 ? std::numeric_limits<double>::infinity() : 0;
  }
  return end.ec == std::errc() ? value : 0;
}

// One part of a duration: digits with underscores, and perhaps a fraction.
struct Amount {
  uint64_t whole = 0;
  std::string_view fraction;
};

std::optional<Amount> take_amount(std::string_view& text) {
  Amount amount;
  size_t i = 0;
  for (; i < text.size() && (is_digit(text[i]) || (i > 0 && text[i] == '_')); ++i) {
    const uint64_t digit = text[i] == '_' ? 0 : static_cast<uint64_t>(text[i] - '0');
    const uint64_t factor = text[i] == '_' ? 1 : 10;
    if (__builtin_mul_overflow(amount.whole, factor, &amount.whole) ||
        __builtin_add_overflow(amount.whole, digit, &amount.whole)) {
      return std::nullopt;
    }
  }
  if (i == 0) {
    return std::nullopt;
  }
  text.remove_prefix(i);
  if (take(text, ".")) {
    const size_t digits = std::min(text.find_first_not_of("0123456789_"), text.size());
    amount.fraction = text.substr(0, digits);
    text.remove_prefix(digits);
    if (digits == 0) {
      return std::nullopt;
    }
  }
  return amount;
}

// 0.fraction of a unit; what is below a nanosecond is cut off. Eighteen digits
// are more than a day has nanoseconds.
uint64_t fraction_ns(std::string_view fraction, uint64_t unit_ns) {
  constexpr uint64_t kMost = 1'000'000'000'000'000'000;
  unsigned __int128 numerator = 0;
  uint64_t denominator = 1;
  for (const char character : fraction) {
    if (character != '_' && denominator < kMost) {
      numerator = numerator * 10 + static_cast<uint64_t>(character - '0');
      denominator *= 10;
    }
  }
  return static_cast<uint64_t>(numerator * unit_ns / denominator);
}

// The unit in front, not before `first` in the order of the table; its index.
std::optional<size_t> take_unit(std::string_view& text, size_t first) {
  const std::string_view name =
      text.substr(0, std::min(text.find_first_of("0123456789_"), text.size()));
  for (size_t i = first; i < ir::kTimeUnits.size(); ++i) {
    const std::string_view unit = ir::kTimeUnits[i].text;
    if (name.size() == unit.size() && starts_with_folded(name, unit)) {
      text.remove_prefix(name.size());
      return i;
    }
  }
  return std::nullopt;
}

std::optional<uint64_t> unsigned_duration(std::string_view text) {
  uint64_t total = 0;
  size_t next_unit = 0;
  while (!text.empty()) {
    const std::optional<Amount> amount = take_amount(text);
    const std::optional<size_t> unit =
        amount ? take_unit(text, next_unit) : std::optional<size_t>();
    if (!unit || (!amount->fraction.empty() && !text.empty())) {
      return std::nullopt;  // only the last part may have a fraction
    }
    const uint64_t unit_ns = ir::kTimeUnits[*unit].ns;
    uint64_t part = 0;
    if (__builtin_mul_overflow(amount->whole, unit_ns, &part) ||
        __builtin_add_overflow(total, part, &total) ||
        __builtin_add_overflow(total, fraction_ns(amount->fraction, unit_ns), &total)) {
      return std::nullopt;
    }
    next_unit = *unit + 1;
    take(text, "_");
  }
  return next_unit == 0 ? std::nullopt : std::optional(total);
}

int64_t duration(std::string_view text) {
  for (const std::string_view prefix : {"LTIME#", "TIME#", "LT#", "T#"}) {
    if (take(text, prefix)) {
      break;
    }
  }
  const bool minus = take_minus(text);
  const uint64_t limit = uint64_t{1} << 63;
  const std::optional<uint64_t> size = unsigned_duration(text);
  if (!size || *size > (minus ? limit : limit - 1)) {
    return 0;
  }
  return static_cast<int64_t>(minus ? 0 - *size : *size);
}

}  // namespace

template <>
uint64_t native<NativeId::kStringToI64>(NativeArg* args) {
  std::string_view text = without_leading_spaces(text_of(args[0]));
  const bool minus = take_minus(text);
  const uint64_t limit = (uint64_t{1} << 63) - (minus ? 0 : 1);
  const uint64_t size = std::min(leading_number(text), limit);
  return minus ? 0 - size : size;
}

template <>
uint64_t native<NativeId::kStringToU64>(NativeArg* args) {
  std::string_view text = without_leading_spaces(text_of(args[0]));
  take(text, "+");
  return leading_number(text);
}

template <>
uint64_t native<NativeId::kStringToF64>(NativeArg* args) {
  std::string_view text = without_leading_spaces(text_of(args[0]));
  const bool minus = take_minus(text);
  const double size = leading_real(text);
  return bits_of(minus ? -size : size);
}

template <>
uint64_t native<NativeId::kStringToBool>(NativeArg* args) {
  const std::string_view text = trimmed(text_of(args[0]));
  return text == "1" || (text.size() == 4 && starts_with_folded(text, "TRUE"));
}

template <>
uint64_t native<NativeId::kStringToTime>(NativeArg* args) {
  return bits_of(duration(trimmed(text_of(args[0]))));
}

}  // namespace stdlib
