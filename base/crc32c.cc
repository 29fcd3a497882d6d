#include "base/crc32c.h"

#include <array>
#include <cstring>

#if defined(__x86_64__)
#include <cpuid.h>
#include <immintrin.h>
#endif

namespace base {
namespace {

constexpr uint32_t kPolynomial = 0x82f63b78u;  // bits reversed
using Tables = std::array<std::array<uint32_t, 256>, 8>;

// tables[n][byte]: what `byte` adds to the remainder when n more bytes follow it.
Tables make_tables() {
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

#if defined(__x86_64__)

bool has_instruction() {
  static const bool kHas = [] {
    unsigned a = 0;
    unsigned b = 0;
    unsigned c = 0;
    unsigned d = 0;
    return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_SSE4_2) != 0;
  }();
  return kHas;
}

__attribute__((target("sse4.2"))) uint32_t crc32c_x86(ByteSpan bytes) {
  uint64_t crc = 0xffffffffu;
  size_t at = 0;
  for (; at + 8 <= bytes.size(); at += 8) {
    uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, 8);
    crc = _mm_crc32_u64(crc, word);
  }
  auto rest = static_cast<uint32_t>(crc);
  for (; at < bytes.size(); ++at) rest = _mm_crc32_u8(rest, bytes[at]);
  return ~rest;
}

#endif

}  // namespace

uint32_t crc32c(ByteSpan bytes) {
#if defined(__x86_64__)
  if (has_instruction()) return crc32c_x86(bytes);
#endif
  return crc32c_portable(bytes);
}

// Eight bytes a step.
uint32_t crc32c_portable(ByteSpan bytes) {
  static const Tables kTables = make_tables();  // where it is needed; 8 KB less in every file
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
