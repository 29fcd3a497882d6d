// The inputs of one task apart from what is received meanwhile, by the strategy of its policy
// (B3, B4). What a scan reads does not change from begin() to end().
#pragma once

#include <cstdint>
#include <span>

#include "base/bytes.h"
#include "ir/bytecode/image.h"
#include "vm/runtime/task_activity.h"

namespace vm {

class InputSync {
 public:
  InputSync() = default;
  InputSync(ir::IoBuffer strategy, size_t bytes);

  // Offers what was received then; `received` has the bytes of the constructor.
  void write(std::span<const uint8_t> received, int64_t at_ns = 0);
  void begin();
  // No scan is going on, and what no scan has seen is old.
  void restart() { fresh_ = locked_ = behind_ = false; }
  bool like(const InputSync& other) const {
    return strategy_ == other.strategy_ && buffers_[0].size() == other.buffers_[0].size();
  }
  void end() { locked_ = false; }
  std::span<const uint8_t> inputs() const { return buffers_[read_]; }
  int64_t received_ns() const { return at_ns_[read_]; }  // when inputs() were
  BufferState state() const;
  // Does a scan see what was received last when nobody writes until just before it begins? Then
  // there is no need to write in every cycle.
  bool reads_last_written() const { return strategy_ == ir::IoBuffer::kCopied; }
  // Must what was received last be written before begin(), so that it is seen? The one buffer of
  // kLocked took nothing while the scan before lasted.
  bool wants_last() const { return reads_last_written() || behind_; }

 private:
  ir::IoBuffer strategy_ = ir::IoBuffer::kCopied;
  base::Bytes buffers_[3];
  int64_t at_ns_[3] = {};
  uint8_t write_ = 0;
  uint8_t wait_ = 2;
  uint8_t read_ = 1;
  bool fresh_ = false;   // written, not yet seen by a scan
  bool locked_ = false;
  bool behind_ = false;  // something was not taken because of the lock
};

}  // namespace vm
