#include "vm/runtime/input_sync.h"

#include <algorithm>
#include <utility>

namespace vm {

using ir::IoBuffer;

InputSync::InputSync(IoBuffer strategy, size_t bytes) : strategy_(strategy) {
  const int count = strategy == IoBuffer::kLocked ? 1 : strategy == IoBuffer::kThree ? 3 : 2;
  for (int i = 0; i < count; ++i) buffers_[i] = base::Bytes(bytes);
  if (strategy == IoBuffer::kLocked) read_ = write_;
}

BufferState InputSync::state() const {
  const bool waits = strategy_ == IoBuffer::kThree;
  return {strategy_, write_, waits ? wait_ : BufferState::kNone, read_, fresh_, locked_};
}

void InputSync::write(std::span<const uint8_t> received, int64_t at_ns) {
  if (strategy_ == IoBuffer::kLocked && locked_) {
    behind_ = true;
    return;
  }
  if (strategy_ == IoBuffer::kFirstUnseen && fresh_) return;
  std::copy(received.begin(), received.end(), buffers_[write_].begin());
  at_ns_[write_] = at_ns;
  fresh_ = true;
  behind_ = false;
  if (strategy_ == IoBuffer::kThree) std::swap(write_, wait_);
}

// Where nothing new has come, the buffer that could be swapped in holds what is older.
void InputSync::begin() {
  locked_ = true;
  if (!fresh_) return;
  fresh_ = false;
  switch (strategy_) {
    case IoBuffer::kLocked:
      break;
    case IoBuffer::kCopied:
      buffers_[read_] = buffers_[write_];  // equal sizes: allocates nothing
      at_ns_[read_] = at_ns_[write_];
      break;
    case IoBuffer::kSwapped:
    case IoBuffer::kSwappedWithFlag:
    case IoBuffer::kFirstUnseen:
      std::swap(read_, write_);
      break;
    case IoBuffer::kThree:
      std::swap(read_, wait_);
      break;
  }
}

}  // namespace vm
