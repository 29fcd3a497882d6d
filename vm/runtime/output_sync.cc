#include "vm/runtime/output_sync.h"

#include <algorithm>
#include <utility>

#include "vm/runtime/byte_masks.h"

namespace vm {

using ir::IoBuffer;

namespace {

constexpr bool has_one_buffer(IoBuffer strategy) {
  return strategy == IoBuffer::kCopied || strategy == IoBuffer::kLocked;
}

bool any_bit(std::span<const uint8_t> mask) {
  uint64_t any = 0;
  for_words(mask.size(), [&](size_t at, size_t size) { any |= load_word(&mask[at], size); });
  return any != 0;
}

void clear(std::span<uint8_t> mask) { std::fill(mask.begin(), mask.end(), uint8_t{0}); }

}  // namespace

OutputSync::OutputSync(IoBuffer strategy, size_t bytes)
    : strategy_(strategy),
      count_(has_one_buffer(strategy) ? 1 : strategy == IoBuffer::kThree ? 3 : 2),
      bytes_(bytes),
      storage_(2 * count_ * bytes) {}

void OutputSync::keep(OutputSync& old) {
  if (strategy_ == old.strategy_) return std::swap(*this, old);
  for (const uint8_t number : {old.read_, old.wait_, old.write_}) {  // the newest last
    if (number < old.count_) write(old.values(number), old.mask(number));
  }
}

// With kCopied the writer has the variables, which are number 0.
BufferState OutputSync::state(bool fresh, bool locked) const {
  const uint8_t waiting = strategy_ == IoBuffer::kThree ? wait_ : BufferState::kNone;
  const uint8_t reader = strategy_ == IoBuffer::kLocked ? write_ : read_;
  return {strategy_, write_, waiting, reader, fresh, locked};
}

// What waits goes over to the buffer that is written; that one was taken, so it has no bits.
void OutputSync::carry(uint8_t from, uint8_t to) {
  std::copy_n(values(from).begin(), bytes_, values(to).begin());
  std::copy_n(mask(from).begin(), bytes_, mask(to).begin());
  clear(mask(from));
}

void OutputSync::write(std::span<const uint8_t> outputs, std::span<const uint8_t> changed) {
  if (strategy_ == IoBuffer::kSwapped) carry(read_, write_);
  if (strategy_ == IoBuffer::kThree) carry(wait_, write_);
  const bool first = strategy_ == IoBuffer::kFirstUnseen && !fresh_;
  const uint8_t to = first ? read_ : write_;
  merge(values(to), outputs, changed);
  merge(mask(to), changed, changed);
  if (strategy_ == IoBuffer::kSwapped) std::swap(write_, read_);
  if (strategy_ == IoBuffer::kThree) std::swap(write_, wait_);
  fresh_ = !first || any_bit(changed);
}

// The buffer that is sent next.
uint8_t OutputSync::next() {
  if (has_one_buffer(strategy_)) return write_;
  if (fresh_ && strategy_ == IoBuffer::kSwappedWithFlag) std::swap(write_, read_);
  if (fresh_ && strategy_ == IoBuffer::kThree) std::swap(wait_, read_);
  return read_;
}

void OutputSync::take(std::span<uint8_t> outputs, std::span<uint8_t> taken) {
  const uint8_t buffer = next();
  fresh_ = false;
  merge(outputs, values(buffer), mask(buffer));
  std::copy_n(mask(buffer).begin(), bytes_, taken.begin());
  clear(mask(buffer));
  if (strategy_ == IoBuffer::kFirstUnseen) take_newest(outputs);
}

// The buffer waits for the next transmission. Changed back to what has been sent, a bit is nothing
// new, and must not stand before what is.
void OutputSync::take_newest(std::span<const uint8_t> sent) {
  const std::span<uint8_t> bits = mask(write_);
  const std::span<const uint8_t> newest = values(write_);
  for (size_t i = 0; i < bytes_; ++i) bits[i] &= static_cast<uint8_t>(newest[i] ^ sent[i]);
  fresh_ = any_bit(bits);
  if (fresh_) std::swap(write_, read_);
}

bool OutputSync::waits() {
  for (uint8_t i = 0; i < count_; ++i) {
    if (any_bit(mask(i))) return true;
  }
  return false;
}

void OutputSync::mark(std::span<uint8_t> waiting) {
  for (uint8_t i = 0; i < count_; ++i) merge(waiting, mask(i), mask(i));
}

void OutputSync::forget(size_t byte, uint8_t bits) {
  for (uint8_t i = 0; i < count_; ++i) mask(i)[byte] &= static_cast<uint8_t>(~bits);
}

void OutputSync::restart() {
  for (uint8_t i = 0; i < count_; ++i) clear(mask(i));
  fresh_ = false;
}

}  // namespace vm
