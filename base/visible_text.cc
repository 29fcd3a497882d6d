#include "base/visible_text.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

namespace base {
namespace {

// Bytes of the character that begins here, when it is one of UTF-8 that is no control character.
size_t printable_bytes(std::string_view text) {
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(text[i]); };
  const uint8_t first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const size_t size = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
  if (size == 0 || size > text.size()) return 0;
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // C1; longer than need be; half of a pair; after the last one.
  const uint8_t second = byte(1);
  const bool bad = (first == 0xc2 && second < 0xa0) || (first == 0xe0 && second < 0xa0) ||
                   (first == 0xed && second >= 0xa0) || (first == 0xf0 && second < 0x90) ||
                   (first == 0xf4 && second >= 0x90);
  return bad ? 0 : size;
}

}  // namespace

uint32_t direction_control(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<uint8_t>(text[i]) : 0u; };
  if (byte(0) == 0xd8 && byte(1) == 0x9c) return 0x061c;
  if (byte(0) != 0xe2 || (byte(1) & 0xfe) != 0x80 || (byte(2) & 0xc0) != 0x80) return 0;
  const uint32_t code = 0x2000 | (byte(1) & 0x3f) << 6 | (byte(2) & 0x3f);
  const bool mark = code == 0x200e || code == 0x200f;
  const bool override = code >= 0x202a && code <= 0x202e;
  const bool isolate = code >= 0x2066 && code <= 0x2069;
  return mark || override || isolate ? code : 0;
}

std::string code_point_text(uint32_t code) {
  char text[16];
  std::snprintf(text, sizeof text, "\\u%04x", code);
  return text;
}

std::string visible(std::string_view text) {
  static constexpr char kHex[] = "0123456789abcdef";
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t size = printable_bytes(text);
    const uint32_t turns = direction_control(text);
    out += turns != 0 ? code_point_text(turns) : std::string(text.substr(0, size));
    if (size == 0) {
      const auto byte = static_cast<uint8_t>(text[0]);
      out += {'\\', 'x', kHex[byte >> 4], kHex[byte & 15]};
    }
    text.remove_prefix(std::max<size_t>(size, 1));
  }
  return out;
}

bool has_control(std::string_view text) {
  bool after_c2 = false;
  for (const char c : text) {
    const auto byte = static_cast<uint8_t>(c);
    if (byte < 0x20 || byte == 0x7f || (after_c2 && byte >= 0x80 && byte < 0xa0)) return true;
    after_c2 = byte == 0xc2;
  }
  return false;
}

std::string visible_lines(std::string_view text) {
  std::string out;
  for (size_t end = text.find('\n'); end != text.npos; end = text.find('\n')) {
    out += visible(text.substr(0, end)) + "\n";
    text.remove_prefix(end + 1);
  }
  return out + visible(text);
}

std::string_view whole_characters(std::string_view text, size_t limit) {
  if (text.size() <= limit) return text;
  while (limit > 0 && (static_cast<uint8_t>(text[limit]) & 0xc0) == 0x80) --limit;
  return text.substr(0, limit);
}

}  // namespace base
