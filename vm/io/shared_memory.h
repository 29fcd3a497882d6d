// Layout of the shared memory that a controller exchanges with another process (docs/IO.md): a
// header, then two blocks. Each block has one writer and any number of readers, and a sequence
// lock: odd while it is written, two more after each write. For both sides.
#pragma once

#include <atomic>
#include <cstdint>
#include <cstring>

namespace vm {

inline constexpr uint32_t kSharedMagic = 0x31435453;  // "STC1"

struct SharedHeader {
  uint32_t magic;         // written last, when all else is in place
  uint32_t header_bytes;  // where the inputs' block begins
  uint32_t input_bytes;   // of the inputs, which the other process writes
  uint32_t output_bytes;  // of the outputs, which the controller writes
};

struct SharedBlock {
  std::atomic<uint64_t> sequence;
  std::atomic<uint64_t> written_ns;  // CLOCK_MONOTONIC; 0: never
};
static_assert(std::atomic<uint64_t>::is_always_lock_free && sizeof(SharedBlock) == 16);

// Bytes of a block with its data, which follow it; a multiple of 8.
inline size_t shared_block_size(size_t bytes) { return sizeof(SharedBlock) + (bytes + 7) / 8 * 8; }

inline uint64_t* shared_words(SharedBlock* block) { return reinterpret_cast<uint64_t*>(block + 1); }

// The first `size` bytes of the block. Each word is released after the odd sequence.
inline void shared_write(SharedBlock* block, const uint8_t* bytes, size_t size, uint64_t now_ns) {
  const uint64_t sequence = block->sequence.load(std::memory_order_relaxed) | 1;
  block->sequence.store(sequence, std::memory_order_relaxed);
  uint64_t* words = shared_words(block);
  for (size_t at = 0; at < size; at += 8, ++words) {
    std::atomic_ref<uint64_t> shared(*words);
    uint64_t word = shared.load(std::memory_order_relaxed);
    std::memcpy(&word, bytes + at, size - at < 8 ? size - at : 8);
    shared.store(word, std::memory_order_release);
  }
  block->written_ns.store(now_ns, std::memory_order_release);
  block->sequence.store(sequence + 1, std::memory_order_release);
}

// One attempt; false: it is being written. `written_ns` 0: it never was.
inline bool shared_read(SharedBlock* block, uint8_t* bytes, size_t size, uint64_t& written_ns) {
  const uint64_t before = block->sequence.load(std::memory_order_acquire);
  if ((before & 1) != 0) return false;
  uint64_t* words = shared_words(block);
  for (size_t at = 0; at < size; at += 8, ++words) {
    const uint64_t word = std::atomic_ref<uint64_t>(*words).load(std::memory_order_acquire);
    std::memcpy(bytes + at, &word, size - at < 8 ? size - at : 8);
  }
  written_ns = block->written_ns.load(std::memory_order_acquire);
  return block->sequence.load(std::memory_order_relaxed) == before;
}

}  // namespace vm
