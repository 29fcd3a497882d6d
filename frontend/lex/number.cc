#include <charconv>
#include <limits>

#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

constexpr size_t kMaxRealDigits = 400;

LiteralProblem bad_number(size_t at, size_t length, std::string text, std::string fix = {}) {
  return {DiagnosticCode::kBadNumber, static_cast<uint32_t>(at), static_cast<uint32_t>(length),
          std::move(text), std::move(fix)};
}

LiteralProblem number_too_large(std::string text) {
  return {DiagnosticCode::kNumberTooLarge, 0, 0, std::move(text), {}};
}

// Underscores stand between digits only (IEC table 5).
bool misplaced_underscore(std::string_view digits, size_t at) {
  bool before = at > 0 && digits[at - 1] != '_';
  bool after = at + 1 < digits.size() && digits[at + 1] != '_';
  return !before || !after;
}

std::string digit_text(char c) {
  return static_cast<uint8_t>(c) < 0x80 ? '`' + std::string(1, c) + '`' : "this character";
}

bool is_base(uint32_t base) { return base == 2 || base == 8 || base == 10 || base == 16; }

void decode_digits(std::string_view digits, size_t offset, uint32_t base, DecodedInteger& out) {
  constexpr uint64_t kMax = std::numeric_limits<uint64_t>::max();
  if (digits.empty()) out.problem = bad_number(0, 0, "digits are missing after `#`");
  for (size_t i = 0; i < digits.size() && !out.problem; ++i) {
    if (digits[i] == '_') {
      if (!misplaced_underscore(digits, i)) continue;
      out.problem = bad_number(offset + i, 1, "`_` stands between two digits only");
      return;
    }
    uint32_t digit = digit_value(digits[i]);
    if (digit >= base) {
      out.problem = bad_number(
          offset + i, 1, digit_text(digits[i]) + " is not a digit of base " + std::to_string(base),
          base == 10 ? "separate number and name, or write 16# in front" : "");
      return;
    }
    if (out.value > (kMax - digit) / base) out.too_large = true;
    out.value = out.value * base + digit;
  }
}

}  // namespace

DecodedInteger decode_integer(std::string_view text) {
  DecodedInteger out;
  uint32_t base = 10;
  size_t hash = text.find('#');
  size_t digits_at = hash == std::string_view::npos ? 0 : hash + 1;
  if (digits_at != 0) {
    std::string_view base_text = text.substr(0, hash);
    auto parsed = std::from_chars(base_text.data(), base_text.data() + base_text.size(), base);
    bool whole = parsed.ec == std::errc() && parsed.ptr == base_text.data() + base_text.size();
    out.based = true;
    if (!whole || !is_base(base)) {
      out.problem = bad_number(0, hash, "the base of a number is 2, 8, 10 or 16");
      return out;
    }
  }
  decode_digits(text.substr(digits_at), digits_at, base, out);
  if (out.too_large && !out.problem) {
    out.value = std::numeric_limits<uint64_t>::max();
    out.problem = number_too_large("this number does not fit into 64 bits");
  }
  return out;
}

DecodedReal decode_real(std::string_view text) {
  DecodedReal out;
  std::string digits;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '_') {
      if (text[i] != '+') digits += text[i];  // from_chars takes no plus
      continue;
    }
    bool between = i > 0 && is_digit(text[i - 1]) && i + 1 < text.size() && is_digit(text[i + 1]);
    if (!between) {
      out.problem = bad_number(i, 1, "`_` stands between two digits only");
      return out;
    }
  }
  if (digits.size() > kMaxRealDigits) {
    out.problem = number_too_large("a real number has at most " + std::to_string(kMaxRealDigits) +
                                   " characters");
    return out;
  }
  auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), out.value);
  bool whole = parsed.ptr == digits.data() + digits.size();
  if (whole && parsed.ec == std::errc::result_out_of_range) {
    // Too small is zero; too large is an error. The exponent's sign tells which.
    bool tiny = text.find("e-") != std::string_view::npos ||
                text.find("E-") != std::string_view::npos || digits[0] == '0';
    out.value = 0;
    if (!tiny) out.problem = number_too_large("this number is larger than any LREAL");
  } else if (!whole || parsed.ec != std::errc()) {
    out.value = 0;
    out.problem = bad_number(0, 0, "this is not a real number", "write it like 1.5 or 2.5E-3");
  }
  return out;
}

}  // namespace frontend
