#include "ir/types/address_text.h"

#include <charconv>

namespace ir {
namespace {

char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool take_number(std::string_view& text, uint64_t& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto used = static_cast<size_t>(end - text.data());
  if (code != std::errc() || used == 0 || value > UINT32_MAX) return false;
  text.remove_prefix(used);
  return true;
}

}  // namespace

DirectArea area_of_letter(char letter) {
  switch (upper(letter)) {
    case 'I':
      return DirectArea::kInput;
    case 'Q':
      return DirectArea::kOutput;
    case 'M':
      return DirectArea::kMarker;
    default:
      return DirectArea::kNone;
  }
}

uint32_t bits_of_letter(char letter) {
  switch (upper(letter)) {
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

std::optional<DirectAddress> parse_address(std::string_view text) {
  if (text.size() < 3 || text[0] != '%') return std::nullopt;
  DirectAddress out;
  out.area = area_of_letter(text[1]);
  if (out.area == DirectArea::kNone) return std::nullopt;
  text.remove_prefix(2);
  out.bit_size = bits_of_letter(text[0]);
  if (out.bit_size == 0) {
    out.bit_size = 1;
  } else {
    text.remove_prefix(1);
  }
  uint64_t number = 0;
  uint64_t bit = 0;
  if (!take_number(text, number)) return std::nullopt;
  if (out.bit_size == 1) {
    if (text.empty() || text[0] != '.') return std::nullopt;
    text.remove_prefix(1);
    if (!take_number(text, bit) || bit > 7) return std::nullopt;
    number = number * 8 + bit;
  } else {
    number *= out.bit_size;
  }
  if (!text.empty() || number >= kOpenAddress) return std::nullopt;
  out.bit_offset = static_cast<uint32_t>(number);
  return out;
}

std::string address_text(const DirectAddress& address) {
  std::string out = "%";
  out += address.area == DirectArea::kInput ? 'I' : address.area == DirectArea::kOutput ? 'Q' : 'M';
  if (address.bit_size <= 1) {  // 0: an image that nobody compiled
    return out + "X" + std::to_string(address.bit_offset / 8) + "." +
           std::to_string(address.bit_offset % 8);
  }
  out += address.bit_size == 8    ? 'B'
         : address.bit_size == 16 ? 'W'
         : address.bit_size == 32 ? 'D'
                                  : 'L';
  return out + std::to_string(address.bit_offset / address.bit_size);
}

}  // namespace ir
