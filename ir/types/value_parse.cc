// Literals of scalars as people type them: parse_scalar of value_text.h. Dates
// and durations are in time_parse.cc, strings in string_parse.cc.
#include <bit>
#include <charconv>
#include <limits>
#include <optional>

#include "base/nearest_name.h"
#include "ir/types/time_parse.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r\n";
  const size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) {
    return {};
  }
  return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

// `_` may stand between two digits (IEC 61131-3 table 5).
std::optional<std::string> without_underscores(std::string_view text) {
  std::string plain;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '_') {
      plain += text[i];
    } else if (i == 0 || i + 1 == text.size() || text[i - 1] == '_') {
      return std::nullopt;
    }
  }
  return plain;
}

struct Magnitude {
  bool negative = false;
  uint64_t value = 0;
};

std::optional<uint64_t> parse_digits(std::string_view text, int radix) {
  const std::optional<std::string> plain = without_underscores(text);
  uint64_t value = 0;
  if (!plain || plain->empty()) {
    return std::nullopt;
  }
  const char* end = plain->data() + plain->size();
  const auto read = std::from_chars(plain->data(), end, value, radix);
  return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

std::optional<Magnitude> parse_magnitude(std::string_view text) {
  Magnitude number;
  if (!text.empty() && (text[0] == '-' || text[0] == '+')) {
    number.negative = text[0] == '-';
    text.remove_prefix(1);
  }
  int radix = 10;
  for (const auto& [prefix, value] :
       {std::pair{"16#", 16}, std::pair{"8#", 8}, std::pair{"2#", 2}}) {
    if (text.starts_with(prefix)) {
      text.remove_prefix(std::string_view(prefix).size());
      radix = value;
      break;
    }
  }
  const std::optional<uint64_t> value = parse_digits(text, radix);
  if (!value) {
    return std::nullopt;
  }
  number.value = *value;
  return number;
}

uint64_t largest(Scalar scalar) {
  const uint32_t width = scalar_size(scalar) * 8 - (is_signed(scalar) ? 1 : 0);
  return width == 64 ? std::numeric_limits<uint64_t>::max() : (uint64_t{1} << width) - 1;
}

std::optional<uint64_t> parse_integer(Scalar scalar, std::string_view text) {
  const std::optional<Magnitude> number = parse_magnitude(text);
  if (!number) {
    return std::nullopt;
  }
  if (!number->negative) {
    return number->value <= largest(scalar) ? std::optional(number->value) : std::nullopt;
  }
  const uint64_t most_negative = is_signed(scalar) ? largest(scalar) + 1 : 0;
  return number->value <= most_negative ? std::optional(0 - number->value) : std::nullopt;
}

std::optional<uint64_t> parse_bool(std::string_view text) {
  if (same_name(text, "TRUE") || text == "1") {
    return 1;
  }
  return same_name(text, "FALSE") || text == "0" ? std::optional<uint64_t>(0) : std::nullopt;
}

template <class Float>
std::optional<Float> parse_float(std::string_view text) {
  if (same_name(text, "NaN")) {
    return std::numeric_limits<Float>::quiet_NaN();
  }
  if (same_name(text, "Inf") || same_name(text, "+Inf")) {
    return std::numeric_limits<Float>::infinity();
  }
  if (same_name(text, "-Inf")) {
    return -std::numeric_limits<Float>::infinity();
  }
  if (text.starts_with('+')) {
    text.remove_prefix(1);
  }
  const std::optional<std::string> plain = without_underscores(text);
  if (!plain || plain->find_first_not_of("0123456789.eE+-") != std::string::npos) {
    return std::nullopt;
  }
  Float value = 0;
  const char* end = plain->data() + plain->size();
  const auto read = std::from_chars(plain->data(), end, value);
  return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

std::optional<uint64_t> parse_real(Scalar scalar, std::string_view text) {
  if (scalar == Scalar::kF32) {
    const std::optional<float> value = parse_float<float>(text);
    return value ? std::optional<uint64_t>(std::bit_cast<uint32_t>(*value)) : std::nullopt;
  }
  const std::optional<double> value = parse_float<double>(text);
  return value ? std::optional(std::bit_cast<uint64_t>(*value)) : std::nullopt;
}

std::optional<uint64_t> parse_character(Kind kind, std::string_view text) {
  const bool wide = kind == Kind::kWchar;
  const base::Result<std::string> bytes = wide ? parse_wstring(text) : parse_string(text);
  if (!bytes.ok() || bytes->size() != (wide ? 2u : 1u)) {
    return std::nullopt;
  }
  uint64_t bits = static_cast<uint8_t>((*bytes)[0]);
  return wide ? bits | static_cast<uint64_t>(static_cast<uint8_t>((*bytes)[1])) << 8 : bits;
}

std::optional<uint64_t> parse_elementary(Kind kind, Scalar scalar, std::string_view text) {
  std::optional<int64_t> ns;
  switch (elementary_group(kind)) {
    case Group::kReal:
      return parse_real(scalar, text);
    case Group::kDuration:
      ns = parse_duration(text);
      break;
    case Group::kDate:
      ns = parse_date(kind, text);
      break;
    case Group::kChar:
      return text.find_first_of("'\"") != std::string_view::npos ? parse_character(kind, text)
                                                                 : parse_integer(scalar, text);
    default:
      return scalar == Scalar::kBool ? parse_bool(text) : parse_integer(scalar, text);
  }
  return ns ? std::optional(static_cast<uint64_t>(*ns)) : std::nullopt;
}

// "INT#5" as INT or as a type derived from it; radix and time prefixes stay.
std::string_view without_type_prefix(const TypeTable& types, TypeId type, std::string_view text) {
  const size_t hash = text.find('#');
  if (hash == std::string_view::npos) {
    return text;
  }
  const std::string_view prefix = text.substr(0, hash);
  if (same_name(prefix, elementary_name(types.root_kind(type))) ||
      (!types[type].name.empty() && same_name(prefix, types[type].name))) {
    const bool time = elementary_group(types.root_kind(type)) == Group::kDuration ||
                      elementary_group(types.root_kind(type)) == Group::kDate;
    return time ? text : text.substr(hash + 1);
  }
  return text;
}

std::optional<uint64_t> find_literal(const Type& type, std::string_view text) {
  if (!type.name.empty() && text.size() > type.name.size() && text[type.name.size()] == '.' &&
      same_name(text.substr(0, type.name.size()), type.name)) {
    text.remove_prefix(type.name.size() + 1);
  }
  for (const EnumLiteral& literal : type.literals) {
    if (same_name(literal.name, text)) {
      return static_cast<uint64_t>(literal.value);
    }
  }
  return std::nullopt;
}

bool in_subrange(const Type& type, Scalar scalar, uint64_t bits) {
  if (is_signed(scalar)) {
    const int64_t value = static_cast<int64_t>(bits);
    return value >= type.low && value <= type.high;
  }
  return bits >= static_cast<uint64_t>(type.low) && bits <= static_cast<uint64_t>(type.high);
}

std::optional<uint64_t> parse_any(const TypeTable& types, TypeId id, std::string_view text,
                                  uint32_t depth) {
  const Type& type = types[id];
  const std::string_view bare = without_type_prefix(types, id, text);
  if (type.kind == Kind::kEnum) {
    if (const auto literal = find_literal(type, bare)) {
      return literal;
    }
  }
  if (type.kind == Kind::kSubrange && depth > 0) {
    const std::optional<uint64_t> bits = parse_any(types, type.base, bare, depth - 1);
    return bits && in_subrange(type, types.scalar(id), *bits) ? bits : std::nullopt;
  }
  // A handle means something only where it came from, so people can only clear it.
  if (is_reference(types.root_kind(id))) {
    return same_name(bare, "NULL") || bare == "0" ? std::optional<uint64_t>(0) : std::nullopt;
  }
  return parse_elementary(types.root_kind(id), types.scalar(id), bare);
}

// Which literal of an enumeration was meant, perhaps.
std::string meant_literal(const TypeTable& types, TypeId id, std::string_view text) {
  for (; types[id].kind == Kind::kSubrange; id = types[id].base) {
  }
  const Type& type = types[id];
  if (type.kind != Kind::kEnum) {
    return {};
  }
  text = text.substr(text.find_last_of("#.") + 1);
  base::NearestName nearest(text);
  for (const EnumLiteral& literal : type.literals) {
    nearest.offer(literal.name);
  }
  return nearest.question();
}

}  // namespace

base::Result<uint64_t> parse_scalar(const TypeTable& types, TypeId type, std::string_view text) {
  constexpr uint32_t kMaxSubranges = 16;
  const std::optional<uint64_t> bits = parse_any(types, type, trimmed(text), kMaxSubranges);
  if (!bits) {
    return base::Error{base::Refusal::kBadValue,
                       "`" + std::string(text) + "` is no value of type " + types.text(type) +
                           meant_literal(types, type, trimmed(text))};
  }
  return *bits;
}

}  // namespace ir
