// Binary coded decimals, and the order of bytes.
#include <limits>

#include "stdlib/native/implementation.h"

namespace stdlib {
namespace {

uint64_t bcd_to_number(uint64_t bcd) {
  uint64_t number = 0;
  for (int shift = 60; shift >= 0; shift -= 4) {
    const uint64_t digit = bcd >> shift & 15;
    if (digit > 9) {
      return std::numeric_limits<uint64_t>::max();
    }
    number = number * 10 + digit;
  }
  return number;
}

uint64_t number_to_bcd(uint64_t number) {
  uint64_t bcd = 0;
  uint64_t rest = number;
  for (int shift = 0; shift < 64; shift += 4, rest /= 10) {
    bcd |= rest % 10 << shift;
  }
  return bcd;
}

uint64_t swap_bytes(uint64_t bits, int32_t bytes) {
  return bytes <= 0 || bytes > 8 ? 0 : __builtin_bswap64(bits) >> (64 - 8 * bytes);
}

}  // namespace

STC_NATIVE(kBcdToNumber, bcd_to_number)
STC_NATIVE(kNumberToBcd, number_to_bcd)
STC_NATIVE(kSwapBytes, swap_bytes)

}  // namespace stdlib
