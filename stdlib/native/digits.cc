// Binary coded decimals, and the order of bytes.
#include <limits>

#include "stdlib/native/implementation.h"

namespace stdlib {

template <>
uint64_t native<NativeId::kBcdToNumber>(NativeArg* args) {
  uint64_t number = 0;
  for (int shift = 60; shift >= 0; shift -= 4) {
    const uint64_t digit = args[0].bits >> shift & 15;
    if (digit > 9) {
      return std::numeric_limits<uint64_t>::max();
    }
    number = number * 10 + digit;
  }
  return number;
}

template <>
uint64_t native<NativeId::kNumberToBcd>(NativeArg* args) {
  uint64_t bcd = 0;
  uint64_t rest = args[0].bits;
  for (int shift = 0; shift < 64; shift += 4, rest /= 10) {
    bcd |= rest % 10 << shift;
  }
  return bcd;
}

template <>
uint64_t native<NativeId::kSwapBytes>(NativeArg* args) {
  const auto bytes = static_cast<uint32_t>(args[1].bits);
  return bytes == 0 || bytes > 8 ? 0 : __builtin_bswap64(args[0].bits) >> (64 - 8 * bytes);
}

}  // namespace stdlib
