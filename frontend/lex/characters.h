// Classes of bytes for the lexer and the literal decoders. Names hold letters,
// digits, `_` and every byte from 0x80 on, so UTF-8 and Latin-1 names both work.
#pragma once

#include <array>
#include <cstdint>

namespace frontend {

enum CharacterClass : uint8_t { kNameStart = 1, kDigitByte = 2, kSpaceByte = 4 };

constexpr std::array<uint8_t, 256> make_character_classes() {
  std::array<uint8_t, 256> table{};
  for (uint32_t c = 0; c < 256; ++c) {
    bool letter = (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c >= 0x80;
    bool space = c == ' ' || (c >= '\t' && c <= '\r');
    bool digit = c >= '0' && c <= '9';
    table[c] = static_cast<uint8_t>((letter ? kNameStart : 0) | (digit ? kDigitByte : 0) |
                                    (space ? kSpaceByte : 0));
  }
  return table;
}
inline constexpr std::array<uint8_t, 256> kCharacterClasses = make_character_classes();

constexpr bool has_class(char c, uint8_t classes) {
  return (kCharacterClasses[static_cast<uint8_t>(c)] & classes) != 0;
}
constexpr bool is_name_start(char c) { return has_class(c, kNameStart); }
constexpr bool is_name_part(char c) { return has_class(c, kNameStart | kDigitByte); }
constexpr bool is_digit(char c) { return has_class(c, kDigitByte); }
constexpr bool is_space(char c) { return has_class(c, kSpaceByte); }

// Which characters above U+007F a name may have: letters and marks of any language, not
// punctuation, symbols, blanks and private characters, which only look like a mistake.
constexpr bool is_name_character(uint32_t code) {
  struct Range {
    uint32_t first, last;
  };
  constexpr Range kNotInNames[] = {
      {0x80, 0xA9},     {0xAB, 0xB4},     {0xB6, 0xB9},     {0xBB, 0xBF},     {0xD7, 0xD7},
      {0xF7, 0xF7},     {0x2000, 0x206F}, {0x2190, 0x2BFF}, {0x3000, 0x3004}, {0x3008, 0x3020},
      {0xE000, 0xF8FF}, {0xFEFF, 0xFEFF}, {0xFF00, 0xFF0F}, {0xFFF0, 0xFFFF}};
  for (Range range : kNotInNames) {
    if (code >= range.first && code <= range.last) return false;
  }
  return true;
}

constexpr bool is_dash(uint32_t code) {
  return (code >= 0x2010 && code <= 0x2015) || code == 0x2212;
}

constexpr char to_upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; }

// 0..35 for digits and letters, 255 otherwise.
constexpr uint32_t digit_value(char c) {
  if (is_digit(c)) return static_cast<uint32_t>(c - '0');
  char upper = to_upper(c);
  return upper >= 'A' && upper <= 'Z' ? static_cast<uint32_t>(upper - 'A') + 10 : 255;
}

}  // namespace frontend
