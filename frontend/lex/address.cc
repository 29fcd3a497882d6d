#include <charconv>

#include "base/limits.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"
#include "ir/types/address_text.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

constexpr uint64_t kMaxBits = uint64_t{1} << 32;

LiteralProblem bad_address(std::string text, std::string fix = {}) {
  return {DiagnosticCode::kBadDirectAddress, 0, 0, std::move(text), std::move(fix)};
}

// Reads a decimal number off the front of `text`.
bool read_number(std::string_view& text, uint32_t& value) {
  auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  if (parsed.ec != std::errc()) return false;
  text.remove_prefix(static_cast<size_t>(parsed.ptr - text.data()));
  return true;
}

// `byte.bit`, or a plain bit number.
MaybeProblem decode_bit(const std::vector<uint32_t>& levels, ir::DirectAddress& address) {
  uint64_t bit = levels[0];
  if (levels.size() == 2) {
    if (levels[1] > 7) return bad_address("the bit of a byte is from 0 to 7");
    bit = bit * 8 + levels[1];
  }
  if (bit >= kMaxBits) return bad_address("this address is too large");
  address.bit_offset = static_cast<uint32_t>(bit);
  return {};
}

// `2.5.7.1`, all of `rest`.
MaybeProblem read_levels(std::string_view rest, std::vector<uint32_t>& levels) {
  for (;;) {
    uint32_t level = 0;
    if (!read_number(rest, level)) {
      return bad_address("a number that is not too large belongs after the size",
                         "write it like %IX0.0 or %QW4");
    }
    levels.push_back(level);
    if (levels.size() > base::kMaxAddressLevels) {
      return bad_address("an address has at most " + std::to_string(base::kMaxAddressLevels) +
                         " levels");
    }
    if (rest.empty()) return {};
    if (rest[0] != '.') return bad_address("only digits belong after the size");
    rest.remove_prefix(1);
  }
}

MaybeProblem decode_size(std::string_view& rest, ir::DirectAddress& address) {
  bool written = !rest.empty() && !is_digit(rest[0]);
  address.bit_size = written ? ir::bits_of_letter(rest[0]) : 1;
  if (address.bit_size == 0) return bad_address("the size of an address is X, B, W, D or L");
  if (written) rest.remove_prefix(1);
  return {};
}

// `text` without the `%`.
MaybeProblem decode_address_text(std::string_view rest, DecodedAddress& out) {
  ir::DirectAddress& address = out.address;
  address.area = ir::area_of_letter(rest[0]);
  if (address.area != ir::DirectArea::kNone) rest.remove_prefix(1);
  if (address.area == ir::DirectArea::kNone && ir::bits_of_letter(rest[0]) == 0) {
    return bad_address("a direct address starts with %I, %Q or %M");
  }
  if (rest == "*") {
    out.incomplete = true;
    return {};
  }
  if (MaybeProblem problem = decode_size(rest, address)) return problem;
  if (rest == "*") {
    out.incomplete = true;
    return {};
  }
  if (MaybeProblem problem = read_levels(rest, out.levels)) return problem;
  bool bit = address.bit_size == 1;
  if (out.levels.size() > (bit ? 2u : 1u)) return {};
  if (bit) {
    MaybeProblem problem = decode_bit(out.levels, address);
    out.levels.clear();
    return problem;
  }
  uint64_t offset = static_cast<uint64_t>(out.levels[0]) * address.bit_size;
  out.levels.clear();
  if (offset + address.bit_size > kMaxBits) return bad_address("this address is too large");
  address.bit_offset = static_cast<uint32_t>(offset);
  return {};
}

}  // namespace

DecodedAddress decode_address(std::string_view text) {
  DecodedAddress out;
  out.problem = decode_address_text(text.substr(1), out);
  return out;
}

DecodedModule decode_module(std::string_view text) {
  DecodedModule out;
  if (text.size() > 2 && text[0] == '%') out.area = ir::area_of_letter(text[1]);
  if (out.area == ir::DirectArea::kNone) {
    out.problem = bad_address("a module of I/O is written %I2.5, %Q2.5 or %M2.5");
    return out;
  }
  out.problem = read_levels(text.substr(2), out.levels);
  return out;
}

DecodedPart decode_part(std::string_view text) {
  DecodedPart out;
  uint32_t bits = ir::bits_of_letter(text[1]);
  std::string_view rest = text.substr(2);
  if (bits == 0 || bits == 64 || !read_number(rest, out.number) || !rest.empty()) {
    out.problem = bad_address("a part of a value is written .%X3, .%B1, .%W1 or .%D0");
    return out;
  }
  out.bit_size = static_cast<uint8_t>(bits);
  return out;
}

}  // namespace frontend
