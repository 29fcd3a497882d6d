#include "ir/types/utf.h"

namespace ir {
namespace {

uint32_t unit_at(std::string_view text, size_t at) {
  return static_cast<uint32_t>(static_cast<uint8_t>(text[at])) |
         static_cast<uint32_t>(static_cast<uint8_t>(text[at + 1])) << 8;
}

bool is_high_surrogate(uint32_t unit) { return unit >= 0xd800 && unit < 0xdc00; }
bool is_low_surrogate(uint32_t unit) { return unit >= 0xdc00 && unit < 0xe000; }
bool is_surrogate(uint32_t code) { return code >= 0xd800 && code < 0xe000; }

std::string unit(uint32_t value) {
  return {static_cast<char>(value & 0xff), static_cast<char>(value >> 8 & 0xff)};
}

// Bytes of a sequence by its first byte; 0 when none starts with it.
uint32_t sequence_length(uint8_t first) {
  if (first < 0x80) return 1;
  if (first >= 0xc2 && first < 0xe0) return 2;
  if (first >= 0xe0 && first < 0xf0) return 3;
  if (first >= 0xf0 && first < 0xf5) return 4;
  return 0;
}

}  // namespace

Utf16Character read_utf16(std::string_view text) {
  const uint32_t first = unit_at(text, 0);
  if (!is_surrogate(first)) {
    return {first, 1, true};
  }
  if (is_high_surrogate(first) && text.size() >= 4 && is_low_surrogate(unit_at(text, 2))) {
    return {0x10000 + ((first - 0xd800) << 10) + (unit_at(text, 2) - 0xdc00), 2, true};
  }
  return {first, 1, false};
}

Utf8Character read_utf8(std::string_view text) {
  const uint8_t first = static_cast<uint8_t>(text[0]);
  const uint32_t length = sequence_length(first);
  if (length == 0 || text.size() < length) {
    return {};
  }
  if (length == 1) {
    return {first, 1};
  }
  uint32_t code = first & (0x7fu >> length);
  for (uint32_t i = 1; i < length; ++i) {
    const uint8_t next = static_cast<uint8_t>(text[i]);
    if ((next & 0xc0) != 0x80) {
      return {};
    }
    code = code << 6 | (next & 0x3f);
  }
  constexpr uint32_t kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool valid = code >= kSmallest[length] && code <= 0x10ffff && !is_surrogate(code);
  return valid ? Utf8Character{code, length} : Utf8Character{};
}

std::string utf8(uint32_t code) {
  const auto tail = [code](uint32_t shift) {
    return static_cast<char>(0x80 | (code >> shift & 0x3f));
  };
  if (code < 0x80) {
    return {static_cast<char>(code)};
  }
  if (code < 0x800) {
    return {static_cast<char>(0xc0 | code >> 6), tail(0)};
  }
  if (code < 0x10000) {
    return {static_cast<char>(0xe0 | code >> 12), tail(6), tail(0)};
  }
  return {static_cast<char>(0xf0 | code >> 18), tail(12), tail(6), tail(0)};
}

std::string utf16le(uint32_t code) {
  if (code < 0x10000) {
    return unit(code);
  }
  const uint32_t rest = code - 0x10000;
  return unit(0xd800 + (rest >> 10)) + unit(0xdc00 + (rest & 0x3ff));
}

}  // namespace ir
