// UTF-8 and UTF-16LE, one character at a time, for WSTRING literals. Malformed
// input is reported, never guessed at.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace ir {

struct Utf16Character {
  uint32_t code = 0;   // the unit itself when it is half a surrogate pair
  uint32_t units = 1;  // UTF-16 units read
  bool valid = true;
};
// `text` has at least two bytes.
Utf16Character read_utf16(std::string_view text);

struct Utf8Character {
  uint32_t code = 0;
  uint32_t bytes = 0;  // 0: malformed
};
// `text` is not empty.
Utf8Character read_utf8(std::string_view text);

std::string utf8(uint32_t code);
std::string utf16le(uint32_t code);

}  // namespace ir
