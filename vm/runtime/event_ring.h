// What the control thread tells of a scan, for others to format and write: records of a fixed size
// in a bounded ring without locks. One thread puts, one takes. Putting allocates nothing, calls
// nothing and never waits; when the ring is full, what does not fit is counted.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/hash.h"

namespace vm {

enum class ScanEventKind : uint8_t { kTrap, kWatchdog, kOverrun, kDeviceLost, kDeviceBack };
inline constexpr size_t kScanEventKinds = 5;

// Text in place; what has no room is cut, at the begin of a character of UTF-8.
class FixedText {
 public:
  static constexpr size_t kBytes = 240;

  void clear() { size_ = 0; }
  FixedText& add(std::string_view text);
  FixedText& add(int64_t number);
  std::string_view view() const { return {bytes_.data(), size_}; }

 private:
  std::array<char, kBytes> bytes_{};
  size_t size_ = 0;
};

struct ScanEvent {
  ScanEventKind kind = ScanEventKind::kTrap;
  int64_t steady_ns = 0;  // of std::chrono::steady_clock; begin() sets it
  uint64_t cycle = 0;
  base::Digest version{};  // that runs; of traps
  FixedText source;        // "task Fast", "device press"
  FixedText text;
};

class EventRing {
 public:
  static constexpr uint64_t kRecords = 256;

  // The control thread: a record to fill, and then it is there to be taken. Null: there is no room,
  // and it counts.
  ScanEvent* begin(ScanEventKind kind);
  void end() { put_.store(put_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

  // The other thread: the oldest one, if any.
  bool take(ScanEvent& out);
  // How many have found no room since the last call.
  uint64_t take_lost(ScanEventKind kind) {
    return lost_[static_cast<size_t>(kind)].exchange(0, std::memory_order_relaxed);
  }

 private:
  std::vector<ScanEvent> records_ = std::vector<ScanEvent>(kRecords);
  std::atomic<uint64_t> put_{0};
  std::atomic<uint64_t> taken_{0};
  std::array<std::atomic<uint64_t>, kScanEventKinds> lost_{};
};

}  // namespace vm
