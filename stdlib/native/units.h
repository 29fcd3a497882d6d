// Code units of strings, eight bytes at a time: how many there are, and moving them. Nothing is
// assumed about alignment, and nothing outside of what is named is read.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

namespace stdlib {

template <class T>
T load(const uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  return value;
}
template <class T>
void store(uint8_t* at, T value) {
  std::memcpy(at, &value, sizeof value);
}

// Units in front of the first NUL, at most `capacity`; reads no unit behind that many and one.
// Eight bytes at a time: the lowest zero unit of a word is where the borrow starts.
template <typename Unit>
uint32_t length_of(const uint8_t* data, uint32_t capacity) {
  constexpr uint32_t kPerWord = 8 / sizeof(Unit);
  constexpr uint64_t kOnes = ~uint64_t{0} / ((uint64_t{1} << (8 * sizeof(Unit))) - 1);
  constexpr uint64_t kHighs = kOnes << (8 * sizeof(Unit) - 1);
  static_assert(std::endian::native == std::endian::little);
  uint32_t at = 0;
  for (; at + kPerWord <= capacity + 1; at += kPerWord) {
    const auto word = load<uint64_t>(data + size_t{at} * sizeof(Unit));
    const uint64_t zeros = (word - kOnes) & ~word & kHighs;
    if (zeros != 0) {
      const auto in_word = static_cast<uint32_t>(std::countr_zero(zeros)) / (8u * sizeof(Unit));
      return std::min<uint32_t>(at + in_word, capacity);
    }
  }
  while (at < capacity && load<Unit>(data + size_t{at} * sizeof(Unit)) != 0) ++at;
  return std::min(at, capacity);
}

// As memmove; most texts are short, and a call costs more than their bytes.
inline void copy_bytes(uint8_t* to, const uint8_t* from, size_t count) {
  if (count > 32) {
    std::memmove(to, from, count);
  } else if (count >= 16) {
    struct Sixteen {
      uint64_t of[2];
    };
    const auto first = load<Sixteen>(from);
    const auto last = load<Sixteen>(from + count - 16);
    store(to, first);
    store(to + count - 16, last);
  } else if (count >= 8) {
    const auto first = load<uint64_t>(from);
    const auto last = load<uint64_t>(from + count - 8);
    store(to, first);
    store(to + count - 8, last);
  } else if (count >= 4) {
    const auto first = load<uint32_t>(from);
    const auto last = load<uint32_t>(from + count - 4);
    store(to, first);
    store(to + count - 4, last);
  } else if (count != 0) {
    const uint8_t first = from[0];
    const uint8_t middle = from[count / 2];
    const uint8_t last = from[count - 1];
    to[0] = first;
    to[count / 2] = middle;
    to[count - 1] = last;
  }
}

// What an assignment of strings does: the source's text, as far as both capacities go, and a NUL.
template <typename Unit>
void assign_text(uint8_t* to, uint32_t to_capacity, const uint8_t* from, uint32_t from_capacity) {
  const uint32_t length = length_of<Unit>(from, std::min(to_capacity, from_capacity));
  copy_bytes(to, from, size_t{length} * sizeof(Unit));
  store(to + size_t{length} * sizeof(Unit), Unit{0});
}

}  // namespace stdlib
