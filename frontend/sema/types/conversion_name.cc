// Conversion functions by their names (IEC 61131-3 tables 22 to 27):
// X_TO_Y, TO_Y, ANY_TO_Y, X_TRUNC_Y, TRUNC_Y, X_BCD_TO_Y, BCD_TO_Y, X_TO_BCD_Y, TO_BCD_Y.
#include "frontend/sema/types/conversion.h"

namespace frontend {
namespace {

using ir::Group;

bool is_integer_kind(ir::Kind kind) {
  Group group = ir::elementary_group(kind);
  return group == Group::kSigned || group == Group::kUnsigned;
}

bool is_bit_string(ir::Kind kind) {
  return ir::elementary_group(kind) == Group::kBit && kind != ir::Kind::kBool;
}

bool take_front(std::string_view& text, std::string_view word) {
  if (text.size() < word.size() || !ir::same_name(text.substr(0, word.size()), word)) return false;
  text.remove_prefix(word.size());
  return true;
}

bool take_back(std::string_view& text, std::string_view word) {
  if (text.size() < word.size() || !ir::same_name(text.substr(text.size() - word.size()), word)) {
    return false;
  }
  text.remove_suffix(word.size());
  return true;
}

// DINT, and UXINT in TO_UXINT, which no other function could be called.
std::optional<ir::Kind> kind_of_conversion(std::string_view name) {
  const auto kind = kind_of_name(name);
  return kind ? kind : kind_of_address_name(name);
}

// `from` is empty when any source will do.
std::optional<Conversion> between(std::string_view from, std::string_view to) {
  Conversion conversion;
  if (take_back(from, "_BCD") || take_back(from, "BCD")) {
    conversion.bcd = Conversion::Bcd::kFrom;
  } else if (take_front(to, "BCD_")) {
    conversion.bcd = Conversion::Bcd::kTo;
  }
  conversion.any_source = from.empty() || ir::same_name(from, "ANY");
  auto source = conversion.any_source ? ir::Kind::kBool : kind_of_conversion(from);
  auto target = kind_of_conversion(to);
  if (!source || !target) return std::nullopt;
  conversion.from = *source;
  conversion.to = *target;
  switch (conversion.bcd) {
    case Conversion::Bcd::kNone:
      return conversion;
    case Conversion::Bcd::kFrom:
      if (!is_integer_kind(*target)) return std::nullopt;
      return conversion.any_source || is_bit_string(*source) ? std::optional(conversion)
                                                             : std::nullopt;
    case Conversion::Bcd::kTo:
      if (!is_bit_string(*target)) return std::nullopt;
      return conversion.any_source || is_integer_kind(*source) ? std::optional(conversion)
                                                               : std::nullopt;
  }
  return std::nullopt;
}

std::optional<Conversion> truncation(std::string_view from, std::string_view to) {
  auto source = from.empty() ? ir::Kind::kReal : kind_of_conversion(from);
  auto target = kind_of_conversion(to);
  if (!source || !target || ir::elementary_group(*source) != Group::kReal ||
      !is_integer_kind(*target)) {
    return std::nullopt;
  }
  Conversion conversion;
  conversion.any_source = from.empty();
  conversion.truncate = true;
  conversion.from = *source;
  conversion.to = *target;
  return conversion;
}

}  // namespace

std::optional<Conversion> conversion_of_name(std::string_view name) {
  std::string_view rest = name;
  if (take_front(rest, "TO_")) return between({}, rest);
  if (take_front(rest, "TRUNC_")) return truncation({}, rest);
  constexpr std::string_view kTo = "_TO_";
  constexpr std::string_view kTrunc = "_TRUNC_";
  for (size_t i = 1; i + kTo.size() < name.size(); ++i) {
    if (ir::same_name(name.substr(i, kTo.size()), kTo)) {
      return between(name.substr(0, i), name.substr(i + kTo.size()));
    }
    if (ir::same_name(name.substr(i, kTrunc.size()), kTrunc)) {
      return truncation(name.substr(0, i), name.substr(i + kTrunc.size()));
    }
  }
  return std::nullopt;
}

// A character is a code or a piece of text, and nothing else; a day has no time of
// day, and the other way round.
bool is_convertible(ir::Kind from, ir::Kind to) {
  auto is_text = [](ir::Kind kind) {
    return kind == ir::Kind::kString || kind == ir::Kind::kWstring;
  };
  auto is_character = [](ir::Kind kind) { return ir::elementary_group(kind) == Group::kChar; };
  auto goes_with_character = [&](ir::Kind kind) {
    return is_character(kind) || is_text(kind) || is_integer_kind(kind) || is_bit_string(kind);
  };
  auto is_day = [](ir::Kind kind) { return kind == ir::Kind::kDate || kind == ir::Kind::kLdate; };
  auto is_clock = [](ir::Kind kind) { return kind == ir::Kind::kTod || kind == ir::Kind::kLtod; };
  if (is_character(from)) return goes_with_character(to);
  if (is_character(to)) return goes_with_character(from);
  return !(is_day(from) && is_clock(to)) && !(is_clock(from) && is_day(to));
}

}  // namespace frontend
