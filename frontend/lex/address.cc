#include <charconv>

#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

constexpr uint64_t kMaxBits = uint64_t{1} << 32;

LiteralProblem bad_address(std::string text, std::string fix = {}) {
  return {DiagnosticCode::kBadDirectAddress, 0, 0, std::move(text), std::move(fix)};
}

// 0 when `letter` is not a size.
uint32_t bits_of(char letter) {
  switch (to_upper(letter)) {
    case 'X':
      return 1;
    case 'B':
      return 8;
    case 'W':
      return 16;
    case 'D':
      return 32;
    case 'L':
      return 64;
    default:
      return 0;
  }
}

ir::DirectArea area_of(char letter) {
  switch (to_upper(letter)) {
    case 'I':
      return ir::DirectArea::kInput;
    case 'Q':
      return ir::DirectArea::kOutput;
    case 'M':
      return ir::DirectArea::kMarker;
    default:
      return ir::DirectArea::kNone;
  }
}

// Reads a decimal number off the front of `text`.
bool read_number(std::string_view& text, uint32_t& value) {
  auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc()) return false;
  text.remove_prefix(static_cast<size_t>(parsed.ptr - text.data()));
  return true;
}

// `byte.bit`, or a plain bit number.
MaybeProblem decode_bit(std::string_view rest, uint32_t first, ir::DirectAddress& address) {
  uint64_t bit = first;
  if (!rest.empty()) {
    uint32_t second = 0;
    rest.remove_prefix(1);
    if (!read_number(rest, second) || !rest.empty()) {
      return bad_address("a bit address has two levels at most: byte.bit");
    }
    if (second > 7) return bad_address("the bit of a byte is from 0 to 7");
    bit = static_cast<uint64_t>(first) * 8 + second;
  }
  if (bit >= kMaxBits) return bad_address("this address is too large");
  address.bit_offset = static_cast<uint32_t>(bit);
  return {};
}

MaybeProblem decode_address_text(std::string_view text, ir::DirectAddress& address) {
  address.area = area_of(text[1]);
  if (address.area == ir::DirectArea::kNone) {
    return bad_address("a direct address starts with %I, %Q or %M");
  }
  std::string_view rest = text.substr(2);
  if (!rest.empty() && rest[0] == '*') {
    return LiteralProblem{DiagnosticCode::kNotSupported, 0, 0,
                          "addresses left open with `*` are not supported yet",
                          "write the address itself, such as %IX0.0"};
  }
  address.bit_size = rest.empty() || is_digit(rest[0]) ? 1 : bits_of(rest[0]);
  if (address.bit_size == 0) return bad_address("the size of an address is X, B, W, D or L");
  if (!rest.empty() && !is_digit(rest[0])) rest.remove_prefix(1);
  uint32_t first = 0;
  if (!read_number(rest, first)) {
    return bad_address("a number that is not too large belongs behind the size",
                       "write it like %IX0.0 or %QW4");
  }
  if (!rest.empty() && rest[0] != '.') return bad_address("only digits belong behind the size");
  if (address.bit_size == 1) return decode_bit(rest, first, address);
  if (!rest.empty()) return bad_address("only bit addresses (X) have two levels");
  uint64_t bit = static_cast<uint64_t>(first) * address.bit_size;
  if (bit + address.bit_size > kMaxBits) return bad_address("this address is too large");
  address.bit_offset = static_cast<uint32_t>(bit);
  return {};
}

}  // namespace

DecodedAddress decode_address(std::string_view text) {
  DecodedAddress out;
  out.problem = decode_address_text(text, out.address);
  return out;
}

DecodedPart decode_part(std::string_view text) {
  DecodedPart out;
  uint32_t bits = bits_of(text[1]);
  std::string_view rest = text.substr(2);
  if (bits == 0 || bits == 64 || !read_number(rest, out.number) || !rest.empty()) {
    out.problem = bad_address("a part of a value is written .%X3, .%B1, .%W1 or .%D0");
    return out;
  }
  out.bit_size = static_cast<uint8_t>(bits);
  return out;
}

}  // namespace frontend
