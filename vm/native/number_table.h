// By its hash, the node that did something last: a table of open addressing that is emptied at
// once, as that happens at every block.
#pragma once

#include <cstdint>
#include <vector>

#include "vm/native/lir.h"

namespace vm::native {

class KnownNodes {
 public:
  void clear() {
    used_ = 0;
    if (++epoch_ != 0) return;
    slots_.assign(slots_.size(), {});  // the numbers of epochs begin anew
    epoch_ = 1;
  }
  // The node becomes what is known; the one before, or kNone.
  uint32_t set(uint64_t hash, uint32_t node) {
    if (2 * used_ >= slots_.size()) grow();
    Slot& slot = slots_[place(hash)];
    if (slot.epoch != epoch_) {
      ++used_;
      slot = {hash, kNone, epoch_};
    }
    const uint32_t before = slot.node;
    slot.node = node;
    return before;
  }

 private:
  struct Slot {
    uint64_t hash = 0;
    uint32_t node = 0;
    uint32_t epoch = 0;  // of clear(); another: it is free
  };
  size_t place(uint64_t hash) const {
    const size_t mask = slots_.size() - 1;
    size_t at = (hash ^ hash >> 32) & mask;
    while (slots_[at].epoch == epoch_ && slots_[at].hash != hash) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    slots_.assign(old.empty() ? 64 : 2 * old.size(), {});
    for (const Slot& slot : old) {
      if (slot.epoch == epoch_) slots_[place(slot.hash)] = slot;
    }
  }
  std::vector<Slot> slots_;  // a power of two of them
  size_t used_ = 0;
  uint32_t epoch_ = 1;
};

}  // namespace vm::native
