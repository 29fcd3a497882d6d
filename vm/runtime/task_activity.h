// What a task is doing and how its buffers stand at one instant (B11), as plain values.
#pragma once

#include <cstdint>

#include "ir/program/ir.h"

namespace vm {

enum class TaskState : uint8_t {
  kWaiting,    // for its next release
  kDue,        // released; more urgent ones have the processor
  kRunning,
  kSuspended,  // in the middle of its scan, below more urgent ones
  kEndedLate,  // as kWaiting; a release had found the last scan not done
  kStopped,    // by a trap
};
inline constexpr uint32_t kTaskStateCount = 6;
const char* state_text(TaskState state);

// For inputs, the writer is what receives and the reader is the scan; for outputs, the writer is
// the scan and the reader is what sends. Buffers are numbered from 0.
struct BufferState {
  static constexpr uint8_t kNone = 3;
  ir::IoBuffer kind = ir::IoBuffer::kCopied;
  uint8_t writer = 0;
  uint8_t waiting = kNone;  // between the two; kNone: there is no such buffer
  uint8_t reader = 1;
  bool fresh = false;   // written, and not yet with the reader
  bool locked = false;  // the scan has it
  friend bool operator==(const BufferState&, const BufferState&) = default;
};

struct TaskActivity {
  TaskState state = TaskState::kWaiting;
  bool late = false;  // due, running or suspended: a release has come meanwhile
  BufferState inputs;
  BufferState outputs;
  friend bool operator==(const TaskActivity&, const TaskActivity&) = default;
};

// In the low 28 bits of a number, and back; of any number.
uint32_t packed(const TaskActivity& activity);
TaskActivity unpacked(uint32_t bits);

}  // namespace vm
