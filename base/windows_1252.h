// Windows-1252, the charset of sources that are no UTF-8: Latin-1, but for the euro sign, dashes,
// quotation marks and some letters, which stand where Latin-1 has control characters.
#pragma once

#include <cstdint>

namespace base {

inline constexpr uint16_t kWindows1252[32] = {  // of the bytes from 0x80 on; 0: no character
    0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021, 0x02C6, 0x2030, 0x0160,
    0x2039, 0x0152, 0,      0x017D, 0,      0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022,
    0x2013, 0x2014, 0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

// A byte that has no character keeps its number.
constexpr uint32_t of_windows_1252(uint8_t byte) {
  const uint32_t code = byte >= 0x80 && byte < 0xA0 ? kWindows1252[byte - 0x80] : 0;
  return code != 0 ? code : byte;
}

// The byte of a character above U+00FF; 0: no such byte.
constexpr uint8_t windows_1252_byte(uint32_t code) {
  for (uint32_t i = 0; code > 0xFF && i < 32; ++i) {
    if (kWindows1252[i] == code) return static_cast<uint8_t>(0x80 + i);
  }
  return 0;
}

}  // namespace base
