// Code units of strings, many at a time: how many there are, and moving them. Nothing is
// assumed about alignment, and nothing outside of what is named is read.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

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

// The lowest zero unit of a word is where the borrow starts: its highest bit; 0: there is none.
template <typename Unit>
uint64_t zeros_of(uint64_t word) {
  static_assert(std::endian::native == std::endian::little);
  constexpr uint64_t kOnes = ~uint64_t{0} / ((uint64_t{1} << (8 * sizeof(Unit))) - 1);
  return (word - kOnes) & ~word & (kOnes << (8 * sizeof(Unit) - 1));
}
template <typename Unit>
uint32_t first_unit(uint64_t bits) {
  return static_cast<uint32_t>(std::countr_zero(bits)) / (8u * sizeof(Unit));
}

// Units in front of the first NUL, at most `capacity`; reads no unit after that many and one.
template <typename Unit>
uint32_t length_of(const uint8_t* data, uint32_t capacity) {
  constexpr uint32_t kPerWord = 8 / sizeof(Unit);
  uint32_t at = 0;
#if defined(__SSE2__)
  constexpr uint32_t kPerVector = 16 / sizeof(Unit);
  for (; at + kPerVector <= capacity + 1; at += kPerVector) {
    const __m128i units =
        _mm_loadu_si128(reinterpret_cast<const __m128i*>(data + size_t{at} * sizeof(Unit)));
    const __m128i zero = _mm_setzero_si128();
    const __m128i found =
        sizeof(Unit) == 1 ? _mm_cmpeq_epi8(units, zero) : _mm_cmpeq_epi16(units, zero);
    const auto bits = static_cast<uint32_t>(_mm_movemask_epi8(found));
    if (bits != 0) {
      const auto in_vector = static_cast<uint32_t>(std::countr_zero(bits)) / sizeof(Unit);
      return std::min<uint32_t>(at + static_cast<uint32_t>(in_vector), capacity);
    }
  }
#endif
  for (; at + kPerWord <= capacity + 1; at += kPerWord) {
    const uint64_t zeros = zeros_of<Unit>(load<uint64_t>(data + size_t{at} * sizeof(Unit)));
    if (zeros != 0) return std::min(at + first_unit<Unit>(zeros), capacity);
  }
  while (at < capacity && load<Unit>(data + size_t{at} * sizeof(Unit)) != 0) ++at;
  return std::min(at, capacity);
}

// -1, 0, 1: as the first units that differ, or as the end of one text says.
template <typename Unit>
int32_t compare_texts(const uint8_t* a, uint32_t a_capacity, const uint8_t* b,
                      uint32_t b_capacity) {
  constexpr uint32_t kPerWord = 8 / sizeof(Unit);
  const uint32_t common = std::min(a_capacity, b_capacity);
  const auto unit = [](const uint8_t* text, uint32_t index) {
    return load<Unit>(text + size_t{index} * sizeof(Unit));
  };
  uint32_t at = 0;
  for (; at + kPerWord <= common; at += kPerWord) {
    const auto left = load<uint64_t>(a + size_t{at} * sizeof(Unit));
    const auto right = load<uint64_t>(b + size_t{at} * sizeof(Unit));
    const uint64_t zeros = zeros_of<Unit>(left);
    const uint64_t differ = left ^ right;
    if ((zeros | differ) == 0) continue;
    const uint32_t end = zeros == 0 ? kPerWord : first_unit<Unit>(zeros);
    const uint32_t other = differ == 0 ? kPerWord : first_unit<Unit>(differ);
    if (end < other) return 0;
    const Unit x = unit(a, at + other);
    const Unit y = unit(b, at + other);
    return int32_t{x > y} - int32_t{x < y};
  }
  // A text that is as long as its capacity ends there.
  for (;; ++at) {
    const Unit x = at < a_capacity ? unit(a, at) : Unit{0};
    const Unit y = at < b_capacity ? unit(b, at) : Unit{0};
    if (x != y) return int32_t{x > y} - int32_t{x < y};
    if (x == 0) return 0;
  }
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
