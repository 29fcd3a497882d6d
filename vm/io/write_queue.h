// Single writes that others make to %Q and %M through a server, on their way to the control
// thread: one thread puts, one takes, nobody waits. What is published together is taken together.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "ir/types/types.h"

namespace vm {

struct OutsideWrite {
  ir::DirectArea area = ir::DirectArea::kNone;
  uint32_t bit = 0;   // of the area
  uint32_t bits = 0;  // 1 or 16
  uint16_t value = 0;
};

class WriteQueue {
 public:
  explicit WriteQueue(size_t capacity) : rows_(capacity) {}

  // Exchange thread: how many may be put; put() shows nothing before publish().
  size_t room() const { return rows_.size() - (put_ - taken_.load(std::memory_order_acquire)); }
  void put(const OutsideWrite& write) { rows_[put_++ % rows_.size()] = write; }
  void publish() { published_.store(put_, std::memory_order_release); }

  // Control thread: true when there was one.
  template <class Each>
  bool take(Each each) {
    const uint64_t end = published_.load(std::memory_order_acquire);
    const uint64_t begin = taken_.load(std::memory_order_relaxed);
    for (uint64_t at = begin; at != end; ++at) each(rows_[at % rows_.size()]);
    taken_.store(end, std::memory_order_release);
    return end != begin;
  }

 private:
  std::vector<OutsideWrite> rows_;
  uint64_t put_ = 0;
  std::atomic<uint64_t> published_{0};
  std::atomic<uint64_t> taken_{0};
};

}  // namespace vm
