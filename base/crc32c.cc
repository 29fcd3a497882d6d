#include "base/crc32c.h"

#include <array>

namespace base {
namespace {

constexpr uint32_t kPolynomial = 0x82f63b78u;  // bits reversed
using Tables = std::array<std::array<uint32_t, 256>, 8>;

// tables[n][byte]: what `byte` adds to the remainder when n more bytes follow it.
constexpr Tables make_tables() {
  Tables tables{};
  for (uint32_t byte = 0; byte < 256; ++byte) {
    uint32_t value = byte;
    for (int bit = 0; bit < 8; ++bit) value = value >> 1 ^ (value % 2 != 0 ? kPolynomial : 0);
    tables[0][byte] = value;
  }
  for (uint32_t byte = 0; byte < 256; ++byte) {
    for (size_t n = 1; n < 8; ++n) {
      const uint32_t before = tables[n - 1][byte];
      tables[n][byte] = before >> 8 ^ tables[0][before & 0xff];
    }
  }
  return tables;
}
constexpr Tables kTables = make_tables();

}  // namespace

// Eight bytes a step.
uint32_t crc32c(ByteSpan bytes) {
  uint32_t crc = 0xffffffffu;
  size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    uint32_t low = 0;
    uint32_t high = 0;
    std::memcpy(&low, bytes.data() + at, 4);
    std::memcpy(&high, bytes.data() + at + 4, 4);
    low ^= crc;
    crc = 0;
    for (uint32_t i = 0; i < 4; ++i) {
      crc ^= kTables[7 - i][low >> (8 * i) & 0xff] ^ kTables[3 - i][high >> (8 * i) & 0xff];
    }
  }
  for (; at < bytes.size(); ++at) crc = crc >> 8 ^ kTables[0][(crc ^ bytes[at]) & 0xff];
  return ~crc;
}

}  // namespace base
