#include "vm/native/arm64/immediates.h"

#include <bit>

namespace vm::native::arm64 {

int64_t sign_extended(uint64_t bits, uint8_t width) {
  const unsigned shift = 64 - 8u * width;
  return static_cast<int64_t>(bits << shift) >> shift;
}

bool is_sum_immediate(int64_t value) {
  const uint64_t size =
      value < 0 ? uint64_t{0} - static_cast<uint64_t>(value) : static_cast<uint64_t>(value);
  return size < 0x1000 || (size < 0x1000000 && (size & 0xfff) == 0);
}

std::optional<uint32_t> logical_immediate(uint64_t bits, uint8_t width) {
  if (width == 4) bits = (bits & 0xffffffffu) | bits << 32;
  if (bits == 0 || ~bits == 0) return std::nullopt;
  unsigned size = 64;  // of what repeats
  while (size > 2) {
    const unsigned half = size / 2;
    const uint64_t mask = (uint64_t{1} << half) - 1;
    if ((bits & mask) != (bits >> half & mask)) break;
    size = half;
  }
  const uint64_t mask = size == 64 ? ~uint64_t{0} : (uint64_t{1} << size) - 1;
  const uint64_t element = bits & mask;
  const auto ones = static_cast<unsigned>(std::popcount(element));
  const uint64_t run = (uint64_t{1} << ones) - 1;
  // Where the run begins; a run around the end begins after the zeros.
  unsigned begin = static_cast<unsigned>(std::countr_zero(element));
  if (begin == 0) {
    const unsigned low = static_cast<unsigned>(std::countr_one(element));
    if (low != ones) begin = size - (ones - low);
  }
  const uint64_t turned = begin == 0 ? run : ((run << begin) | (run >> (size - begin))) & mask;
  if (turned != element) return std::nullopt;
  const uint32_t n = size == 64 ? 1 : 0;
  const uint32_t immr = (size - begin) % size;
  const uint32_t imms = ((~(size - 1) << 1) & 0x3f) | (ones - 1);
  return n << 12 | immr << 6 | imms;
}

std::optional<uint32_t> logical_immediate_of(uint64_t bits, uint8_t width) {
  if (width >= 4) return logical_immediate(bits, width);
  const uint64_t mask = (uint64_t{1} << (8 * width)) - 1;
  const uint64_t low = bits & mask;
  const uint64_t repeated = low * (width == 1 ? 0x01010101u : 0x00010001u);
  for (const uint64_t form : {low, low | ~mask, repeated}) {
    if (const auto found = logical_immediate(form & 0xffffffffu, 4)) return found;
  }
  return std::nullopt;
}

std::optional<uint8_t> float_immediate(uint64_t bits, uint8_t width) {
  const unsigned fraction_bits = width == 4 ? 23 : 52;
  const unsigned exponent_bits = width == 4 ? 8 : 11;
  const uint64_t fraction = bits & ((uint64_t{1} << fraction_bits) - 1);
  if ((fraction & ((uint64_t{1} << (fraction_bits - 4)) - 1)) != 0) return std::nullopt;
  const auto exponent =
      static_cast<int64_t>(bits >> fraction_bits & ((uint64_t{1} << exponent_bits) - 1));
  const int64_t r = exponent - ((int64_t{1} << (exponent_bits - 1)) - 1);
  if (r < -3 || r > 4) return std::nullopt;
  const uint64_t sign = bits >> (8 * width - 1) & 1;
  const uint64_t power = static_cast<uint64_t>(r + 7) & 7;  // -3 is 4, 0 is 7, 4 is 3
  return static_cast<uint8_t>(sign << 7 | power << 4 | fraction >> (fraction_bits - 4));
}

}  // namespace vm::native::arm64
