// What the controller derives from one image: tasks with everything they need to run, the
// process image, forces. Built beside the running program, so that a change only has to
// store a pointer; a scan allocates nothing.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "vm/runtime/controller.h"
#include "vm/runtime/histogram.h"
#include "vm/runtime/input_sync.h"
#include "vm/runtime/output_sync.h"
#include "vm/runtime/process_image.h"
#include "vm/runtime/recent_longest.h"
#include "vm/runtime/safe_outputs.h"
#include "vm/runtime/shared_globals.h"

namespace vm {

// In memory of its own: a change hands it on.
struct TaskHistory {
  Histogram run;
  Histogram delay;
  RecentLongest recent_run;
};

// A task, and its activation while it has one. At most one activation exists for each task.
struct TaskSlot {
  TaskStatus status;
  int64_t watchdog_ns = 0;
  std::vector<uint32_t> programs;  // instance IDs
  std::unique_ptr<Execution> execution;
  std::unique_ptr<TaskHistory> times = std::make_unique<TaskHistory>();
  ir::TaskPolicy policy;
  InputSync inputs;              // what an activation sees of %I, from start to end (B3)
  base::Bytes outputs_at_start;  // %Q variables when it began, to know what it wrote
  base::Bytes own_outputs;       // mask: what it writes, as far as is known
  OutputSync outputs;            // what its scans have written, until it is sent (B5, B6)
  int64_t next_release_ns = 0;
  int64_t released_ns = 0;      // when the release was due that it begins with
  bool once = false;            // start code
  bool released = false;        // due, not yet begun
  bool due_again = false;       // its scan was not done; what its end does: ir::Overrun
  int64_t due_again_ns = 0;     // since when
  bool overran = false;         // due again, to be ended by a trap
  bool io_lost = false;         // its next scan begins with a trap
  uint64_t begun_in_cycle = 0;  // number of the cycle, from 1: once in each at most
  TaskState state = TaskState::kWaiting;
  bool late = false;     // a release has found it not done
  bool unsent = false;   // complete outputs of it are in TaskTables::outputs, not sent yet
  bool held = false;     // complete outputs of it are in its own `outputs`
  bool lasting = false;  // its code is done, and it lasts until run_ns is scan_ns
  int64_t scan_ns = 0;   // Clock::scan_ns

  uint32_t event = 0;        // data offset of the BOOL whose edges release it; 0: none
  bool event_level = false;  // when it was looked at last
  uint32_t event_byte = 0;   // in the inputs, when the event is one
  uint8_t event_mask = 0;    // 0: it is none

  size_t program = 0;  // position in `programs`
  uint32_t stack = 0;
  int64_t time_ns = 0;  // the one timestamp of the scan
  int64_t run_ns = 0;
  uint64_t fuel_used = 0;  // by the programs that are done

  bool synchronous() const { return policy.io == ir::TaskIo::kSynchronous; }
  bool exchanges() const { return policy.exchange == ir::TaskExchange::kOwn; }
  BufferState output_state() const;
};

struct TaskTables {
  TaskTables(const Generation& made_for, int64_t first_release_ns);

  // Scans, statistics and phase of tasks of the same name go on (change case 42).
  void adopt(TaskTables& previous, int64_t cycle_start_ns);
  void forget_times() {
    for (TaskSlot& task : tasks) *task.times = TaskHistory();
  }
  // Since the start, also those of tasks that a change took away.
  uint64_t missed_releases() const;
  uint64_t load() const;  // Controller::load()
  // Greatest common divisor of periods and phases: every release falls on a cycle (B1).
  void set_base_period();
  // The first cycle after `cycle_start_ns`.
  int64_t next_cycle_ns(int64_t cycle_start_ns) const;
  int64_t next_release_ns() const;
  // Compares the outputs of the version that runs and one that is prepared, or the other way round.
  static void compare_outputs(TaskTables& a, TaskTables& b);
  // The set and its code come into force, and `set` has what was before. Nothing is freed.
  void exchange_forces(ForcedSet& set);
  // ForcedSet::adopt() for this version.
  ForcedSet adopted_forces(const ir::Image& from, const std::vector<Force>& forces,
                           const TierOptions& tier, ForceList back) const;

  const Generation* generation;
  std::shared_ptr<const CodeTable> own_code;  // of the generation, when it was made
  const CodeTable* code;                      // what its executions run: that, or one in its place
  ir::VerifiedImage version;    // outlives the generation, which its owner may drop at any time
  std::vector<TaskSlot> tasks;  // as in the image
  uint64_t missed_before = 0;   // modulo 2^64: what their counters do not have of the missed ones
  std::vector<uint32_t> by_priority;  // highest first, then as declared
  int64_t base_period_ns = 0;
  ir::Schedule schedule = ir::Schedule::kSendFirst;
  ProcessImage process_image;
  SharedGlobals shared;
  SafeOutputs safe;
  base::Bytes inputs;   // as received last in a cycle
  base::Bytes outputs;  // as sent next in a cycle: complete results only (B5)
  // Where tasks exchange by themselves (B12), else empty: as received last and as sent last.
  base::Bytes newest_inputs;
  base::Bytes sent_outputs;
  base::Bytes unused;        // mask: outputs that no variable stands for
  base::Bytes waiting_mask;  // what is in buffers of the tasks
  base::Bytes written;       // by the task that ends
  base::Bytes lost;          // IoPort::lost_tasks
  base::Bytes scratch;
  base::Bytes forced_outputs;  // mask
  // No outputs wait, and none can be NaN: a scan that nobody is suspended below just packs them.
  bool plain_outputs = false;
  // Are outputs of this version and the other one the same? Then what waits is kept, and what is
  // known of its writers.
  bool same_outputs = false;
  ForcedSet forced;
  base::Bytes seen_inputs;  // with the forced ones in them
  // An input as the program sees it.
  uint8_t input(size_t byte, uint8_t received) const {
    if (byte >= forced.input_mask.size()) return received;
    const uint8_t mask = forced.input_mask[byte];
    return static_cast<uint8_t>((received & ~mask) | (forced.inputs[byte] & mask));
  }

 private:
  void find_base_period();
  void keep_outputs(TaskSlot& slot, TaskSlot& old);
  void keep_inputs(TaskSlot& slot, TaskSlot& old);
};

}  // namespace vm
