// Ranges of bits between the process image and exchanged bytes: bit 0 of byte 0 comes first.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace vm {

// `bits` bits of `from`, from its bit `from_bit` on, to `to`. Both have room.
inline void copy_bits(std::span<const uint8_t> from, uint32_t from_bit, std::span<uint8_t> to,
                      uint32_t to_bit, uint32_t bits) {
  if (from_bit % 8 == 0 && to_bit % 8 == 0) {
    const uint32_t whole = bits / 8;
    if (whole != 0) std::memcpy(to.data() + to_bit / 8, from.data() + from_bit / 8, whole);
    from_bit += whole * 8;
    to_bit += whole * 8;
    bits %= 8;
  }
  for (uint32_t i = 0; i < bits; ++i, ++from_bit, ++to_bit) {
    const auto mask = static_cast<uint8_t>(1u << (to_bit % 8));
    if ((from[from_bit / 8] >> (from_bit % 8) & 1) != 0) {
      to[to_bit / 8] |= mask;
    } else {
      to[to_bit / 8] &= static_cast<uint8_t>(~mask);
    }
  }
}

inline void clear_bits(std::span<uint8_t> to, uint32_t to_bit, uint32_t bits) {
  for (; bits != 0 && to_bit % 8 != 0; --bits, ++to_bit) {
    to[to_bit / 8] &= static_cast<uint8_t>(~(1u << (to_bit % 8)));
  }
  if (bits / 8 != 0) std::memset(to.data() + to_bit / 8, 0, bits / 8);
  to_bit += bits / 8 * 8;
  for (bits %= 8; bits != 0; --bits, ++to_bit) {
    to[to_bit / 8] &= static_cast<uint8_t>(~(1u << (to_bit % 8)));
  }
}

}  // namespace vm
