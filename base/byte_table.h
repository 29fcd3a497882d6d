// ByteTable: numbers of keys that are strings of bytes. Keys lie one after the other in memory of
// the table, so that a new one takes no memory of its own, and clear() keeps what there is.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

namespace base {

class ByteTable {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;

  // kNone when the key is not there.
  uint32_t find(std::string_view key) const {
    return count_ == 0 ? kNone : slots_[slot_of(key, hash_of(key))].number;
  }
  // The number of the key, which is `number` when it is new.
  uint32_t add(std::string_view key, uint32_t number) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    const uint32_t hash = hash_of(key);
    Slot& slot = slots_[slot_of(key, hash)];
    if (slot.number != kNone) return slot.number;
    slot = {hash, static_cast<uint32_t>(keys_.size()), static_cast<uint32_t>(key.size()), number};
    keys_.insert(keys_.end(), key.begin(), key.end());
    ++count_;
    return number;
  }
  // A table that was large once does not make this slow for ever.
  void clear() {
    if (count_ == 0) return;
    const bool large = slots_.size() > kFirst && slots_.size() > 8 * count_;
    keys_.clear();
    slots_.assign(large ? slots_.size() / 2 : slots_.size(), {});
    count_ = 0;
  }

 private:
  static constexpr size_t kFirst = 32;

  struct Slot {
    uint32_t hash = 0;
    uint32_t begin = 0;  // of the key
    uint32_t size = 0;
    uint32_t number = kNone;
  };

  static uint32_t hash_of(std::string_view key) {
    constexpr uint64_t kFactor = 0x9e3779b97f4a7c15u;
    uint64_t hash = key.size();
    size_t at = 0;
    for (uint64_t piece = 0; at + sizeof piece <= key.size(); at += sizeof piece) {
      std::memcpy(&piece, key.data() + at, sizeof piece);
      hash = (hash ^ piece) * kFactor;
      hash ^= hash >> 32;
    }
    uint64_t rest = 0;
    for (; at < key.size(); ++at) rest = rest << 8 | static_cast<uint8_t>(key[at]);
    hash = (hash ^ rest) * kFactor;
    return static_cast<uint32_t>(hash >> 32);
  }

  // The slot of the key, or the empty one where it belongs.
  size_t slot_of(std::string_view key, uint32_t hash) const {
    const size_t mask = slots_.size() - 1;
    for (size_t i = hash & mask;; i = (i + 1) & mask) {
      const Slot& slot = slots_[i];
      if (slot.number == kNone) return i;
      const bool same = slot.hash == hash && slot.size == key.size() &&
                        std::memcmp(keys_.data() + slot.begin, key.data(), key.size()) == 0;
      if (same) return i;
    }
  }

  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    slots_.assign(old.empty() ? kFirst : old.size() * 2, {});
    const size_t mask = slots_.size() - 1;
    for (const Slot& slot : old) {
      if (slot.number == kNone) continue;
      size_t i = slot.hash & mask;
      while (slots_[i].number != kNone) i = (i + 1) & mask;
      slots_[i] = slot;
    }
  }

  std::vector<char> keys_;
  std::vector<Slot> slots_;  // a power of two
  size_t count_ = 0;
};

}  // namespace base
