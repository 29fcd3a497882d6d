// Copies of what a running program has in memory, for whoever makes text of it: taken at boundaries
// in portions that no scan waits for. What does not fit into the time before the next cycle waits
// for a later boundary; when a cycle had no time at all, the next one copies kLeastBytes. Up to
// kMaxBoundaryBytes are values of one boundary; they wait for one with time enough, but no
// longer than kPatience boundaries. Everything is prepared off the control thread, so that nothing
// is allocated at a boundary.
#pragma once

#include <vector>

#include "base/limits.h"
#include "ir/bytecode/value_ranges.h"
#include "vm/exec/memory.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/histogram.h"

namespace vm {

// Bytes are counted in whole lines of the cache.
inline constexpr uint64_t kMaxBoundaryBytes = base::kMaxBoundaryBytes;  // copied at one boundary
inline constexpr uint64_t kMaxReadBytes = base::kMaxReadBytes;          // copied for one request
// A copied byte is read and written; the model of the pause uses the same number.
inline constexpr int64_t kCopyBytesPerNs = 2;
inline constexpr uint64_t kLeastBytes = 1u << 14;  // in the second cycle, also without free time
inline constexpr int kPatience = 200;              // boundaries without a share, before it hurries

// How much one request may do at the boundaries that it gets.
class BoundaryShare {
 public:
  // Bytes of work at this boundary, of which `left` are still to be done; 0: at a later one.
  // `whole`: all or nothing. `free_ns`: until the next cycle begins.
  uint64_t bytes(const Controller& controller, int64_t free_ns, uint64_t left, bool whole);

 private:
  uint64_t cycle_ = 0;  // the last cycle with a share, or the first one without time for it
  int waited_ = 0;      // boundaries without a share since then
};

// kLater: this boundary had no time for it.
enum class Copied : uint8_t { kPart, kLater, kAll, kOtherProgram };

class LiveCopy {
 public:
  // A copy of the program that runs now; `ranges` lie in its data memory. kTooLarge.
  static base::Result<LiveCopy> prepare(const Controller& controller,
                                        std::vector<ir::DataRange> ranges);
  // At a boundary. kOtherProgram: another version runs than when this was prepared.
  Copied take(Controller& controller, int64_t free_ns);

  // The ranges, where they lie in data memory; anything else is zero.
  std::span<const uint8_t> memory() const { return memory_.view(); }
  // The cycles of the boundaries at which the first and the last of it was copied.
  uint64_t first_cycle() const { return first_cycle_; }
  uint64_t last_cycle() const { return last_cycle_; }

 private:
  explicit LiveCopy(Memory memory) : memory_(std::move(memory)) {}
  uint64_t copy(const uint8_t* from, uint64_t room);

  Memory memory_;
  std::vector<ir::DataRange> ranges_;  // sorted, at least a line apart
  uint32_t generation_ = 0;
  uint64_t left_ = 0;  // bytes of lines
  bool whole_ = false;
  size_t range_ = 0;  // where to go on
  uint32_t offset_ = 0;
  bool begun_ = false;
  uint64_t first_cycle_ = 0;
  uint64_t last_cycle_ = 0;
  BoundaryShare share_;
};

// Counters and times of a task at one boundary; of different ones in a copy of several.
struct TaskSample {
  TaskStatus status;  // without times
  Histogram run;
  Histogram delay;
};
TaskStatus status_of(const TaskSample& sample);
TaskTimes times_of(const TaskSample& sample);

class TaskCopy {
 public:
  // A copy of all tasks, or of the one of that name; none when there is no such task.
  TaskCopy(const Controller& controller, std::string_view name);
  // At a boundary, as LiveCopy.
  Copied take(Controller& controller, int64_t free_ns);
  const std::vector<TaskSample>& samples() const { return samples_; }

 private:
  uint32_t generation_;
  size_t first_ = 0;
  size_t taken_ = 0;
  std::vector<TaskSample> samples_;
  BoundaryShare share_;
};

// Bytes of the lines that the ranges touch; sorts them.
uint64_t line_bytes(std::vector<ir::DataRange>& ranges);

}  // namespace vm
