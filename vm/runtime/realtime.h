// What a control thread can ask of Linux. Nothing in the design depends on any of it; each part
// that the machine refuses is an error with the way out, before the first scan.
#pragma once

#include <cstdint>
#include <optional>

#include "base/result.h"
#include "vm/runtime/controller.h"

namespace vm {

struct RealTimeOptions {
  uint32_t fifo_priority = 0;   // SCHED_FIFO 1..99; 0: as the process is
  std::optional<uint32_t> cpu;  // the control thread stays there
  bool lock_memory = false;     // nothing is swapped out, and what is used is there from the start
  bool confined = false;        // thread_filter.h, after all else
};

// Makes the calling thread real-time; kNotPermitted, kUsage for a processor that is not there.
base::Status make_real_time(const RealTimeOptions& options);
// The calling thread gives way to all others.
void run_in_background();
// Touches the pages of all data areas and of the stack, so that no scan meets a page fault.
void prefault(Controller& controller);

}  // namespace vm
