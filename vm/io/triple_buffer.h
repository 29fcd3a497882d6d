// Newest value from one thread to one other, whole and without waiting on either side: the writer
// fills one of three buffers and swaps it for the waiting one, the reader takes the waiting one if
// it is new. One atomic exchange each; nothing is allocated after construction.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

namespace vm {

class TripleBuffer {
 public:
  explicit TripleBuffer(size_t bytes) {
    for (std::vector<uint8_t>& buffer : buffers_) buffer.resize(bytes);
  }
  TripleBuffer(const TripleBuffer&) = delete;
  TripleBuffer& operator=(const TripleBuffer&) = delete;

  // Writer: the buffer to fill; what it holds is old. Then publish().
  std::span<uint8_t> work() { return buffers_[work_]; }
  void publish() {
    work_ =
        waiting_.exchange(static_cast<uint8_t>(work_ | kNew), std::memory_order_acq_rel) & kIndex;
  }

  // Reader: true when something was published since the last take().
  bool take() {
    if ((waiting_.load(std::memory_order_relaxed) & kNew) == 0) return false;
    read_ = waiting_.exchange(read_, std::memory_order_acq_rel) & kIndex;
    return true;
  }
  std::span<const uint8_t> newest() const { return buffers_[read_]; }

 private:
  static constexpr uint8_t kIndex = 3;
  static constexpr uint8_t kNew = 4;

  std::array<std::vector<uint8_t>, 3> buffers_;
  uint8_t work_ = 0;  // the writer's
  uint8_t read_ = 1;  // the reader's
  std::atomic<uint8_t> waiting_{2};
};

}  // namespace vm
