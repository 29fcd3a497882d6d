// Bits of the process image, taken over under a mask. Eight bytes a step: images can be large, and
// this happens in every scan.
#pragma once

#include <cstdint>
#include <cstring>
#include <span>

namespace vm {

// Calls `word(offset, size)` for pieces of 8 bytes, and for those that are left one by one.
template <class Word>
inline void for_words(size_t bytes, Word word) {
  size_t at = 0;
  for (; at + 8 <= bytes; at += 8) word(at, size_t{8});
  for (; at < bytes; ++at) word(at, size_t{1});
}

inline uint64_t load_word(const uint8_t* at, size_t size) {
  uint64_t word = 0;
  if (size == 8) {
    std::memcpy(&word, at, 8);
  } else {
    word = *at;
  }
  return word;
}

inline void store_word(uint8_t* at, size_t size, uint64_t word) {
  if (size == 8) {
    std::memcpy(at, &word, 8);
  } else {
    *at = static_cast<uint8_t>(word);
  }
}

// The bits of `mask` in `to` become those of `from`. All have the size of `to`.
inline void merge(std::span<uint8_t> to, std::span<const uint8_t> from,
                  std::span<const uint8_t> mask) {
  for_words(to.size(), [&](size_t at, size_t size) {
    const uint64_t bits = load_word(&mask[at], size);
    const uint64_t kept = load_word(&to[at], size) & ~bits;
    store_word(&to[at], size, kept | (load_word(&from[at], size) & bits));
  });
}

// Sets the bits of `mask` in which `a` and `b` differ.
inline void add_differences(std::span<uint8_t> mask, std::span<const uint8_t> a,
                            std::span<const uint8_t> b) {
  for_words(mask.size(), [&](size_t at, size_t size) {
    const uint64_t differ = load_word(&a[at], size) ^ load_word(&b[at], size);
    store_word(&mask[at], size, load_word(&mask[at], size) | differ);
  });
}

}  // namespace vm
