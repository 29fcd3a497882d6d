#include "vm/runtime/event_ring.h"

#include <chrono>
#include <cstring>

#include "base/visible_text.h"

namespace vm {

FixedText& FixedText::add(std::string_view text) {
  text = base::whole_characters(text, kBytes - size_);
  std::memcpy(bytes_.data() + size_, text.data(), text.size());
  size_ += text.size();
  return *this;
}

FixedText& FixedText::add(int64_t number) {
  char digits[20];
  size_t at = sizeof digits;
  auto rest = static_cast<uint64_t>(number);
  if (number < 0) rest = 0 - rest;
  do digits[--at] = static_cast<char>('0' + rest % 10);
  while ((rest /= 10) != 0);
  if (number < 0) add("-");
  return add(std::string_view(digits + at, sizeof digits - at));
}

// The record still has what an older one left there. The clock is read without a system call.
ScanEvent* EventRing::begin(ScanEventKind kind) {
  const uint64_t at = put_.load(std::memory_order_relaxed);
  if (at - taken_.load(std::memory_order_acquire) == kRecords) {
    lost_[static_cast<size_t>(kind)].fetch_add(1, std::memory_order_relaxed);
    return nullptr;
  }
  ScanEvent& event = records_[at % kRecords];
  event.kind = kind;
  event.steady_ns =
      std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  event.cycle = 0;
  event.version = {};
  event.source.clear();
  event.text.clear();
  return &event;
}

bool EventRing::take(ScanEvent& out) {
  const uint64_t at = taken_.load(std::memory_order_relaxed);
  if (at == put_.load(std::memory_order_acquire)) return false;
  out = records_[at % kRecords];
  taken_.store(at + 1, std::memory_order_release);
  return true;
}

}  // namespace vm
