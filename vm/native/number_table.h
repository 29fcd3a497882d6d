// Numbers by key: a table of open addressing that is emptied at once, as that happens at every
// block.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "vm/native/lir.h"

namespace vm::native {

class NumberTable {
 public:
  void clear() {
    used_ = 0;
    if (++epoch_ != 0) return;
    slots_.assign(slots_.size(), {});  // the numbers of epochs begin anew
    epoch_ = 1;
  }
  // kNone: none.
  uint32_t find(uint64_t key) const {
    if (used_ == 0) return kNone;
    const Slot& slot = slots_[place(key)];
    return slot.epoch == epoch_ ? slot.number : kNone;
  }
  // The key's number from now on; gives the one before, or kNone.
  uint32_t set(uint64_t key, uint32_t number) {
    Slot& slot = at(key);
    const uint32_t before = slot.number;
    slot.number = number;
    return before;
  }
  // The number of the key; `fresh` becomes that of a key without one.
  uint32_t add(uint64_t key, uint32_t fresh) {
    Slot& slot = at(key);
    if (slot.number == kNone) slot.number = fresh;
    return slot.number;
  }

 private:
  struct Slot {
    uint64_t key = 0;
    uint32_t number = 0;
    uint32_t epoch = 0;  // of clear(); another: it is free
  };
  Slot& at(uint64_t key) {
    if (2 * used_ >= slots_.size()) grow();
    Slot& slot = slots_[place(key)];
    if (slot.epoch != epoch_) {
      ++used_;
      slot = {key, kNone, epoch_};
    }
    return slot;
  }
  size_t place(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    size_t at = (key * 0x9e3779b97f4a7c15u >> 32) & mask;
    while (slots_[at].epoch == epoch_ && slots_[at].key != key) at = (at + 1) & mask;
    return at;
  }
  void grow() {
    const std::vector<Slot> old = std::move(slots_);
    slots_.assign(old.empty() ? 16 : 2 * old.size(), {});
    for (const Slot& slot : old) {
      if (slot.epoch == epoch_) slots_[place(slot.key)] = slot;
    }
  }
  std::vector<Slot> slots_;  // a power of two of them
  size_t used_ = 0;
  uint32_t epoch_ = 1;
};

// Integers as values of a Function: one for each number and width that is asked for here.
class Constants {
 public:
  explicit Constants(Function& function) : f_(function) {}
  Val of(uint64_t bits, uint8_t width) {
    bits &= ~uint64_t{0} >> (64 - 8 * width);
    const auto fresh = static_cast<Val>(f_.values.size());
    const Val value = known_[std::countr_zero(width)].add(bits, fresh);
    if (value == fresh) f_.values.push_back({false, width, true, bits, kNone, 0});
    return value;
  }

 private:
  Function& f_;
  NumberTable known_[4];  // by width
};

// A T for each key that was asked for.
template <class T>
class ByKey {
 public:
  T& operator[](uint64_t key) {
    const uint32_t number = numbers_.add(key, static_cast<uint32_t>(all_.size()));
    if (number == all_.size()) all_.emplace_back();
    return all_[number];
  }
  const T* find(uint64_t key) const {
    const uint32_t number = numbers_.find(key);
    return number == kNone ? nullptr : &all_[number];
  }
  const T& at(uint64_t key) const { return all_[numbers_.find(key)]; }  // which it has
  const std::vector<T>& all() const { return all_; }

 private:
  NumberTable numbers_;
  std::vector<T> all_;
};

}  // namespace vm::native
