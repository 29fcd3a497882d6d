// Makes machine code on a thread in the background (Making::kBeside), so that neither the first
// scan nor a change need wait for it. The program is interpreted until then, and on when there is
// no room for machine code, or no thread.
#pragma once

#include <pthread.h>

#include <cstdint>
#include <future>
#include <memory>
#include <optional>

#include "vm/load/generation.h"
#include "vm/native/program.h"
#include "vm/runtime/task_tables.h"

namespace vm {

// One thread at a time calls what is not marked otherwise.
class NativeMaker {
 public:
  ~NativeMaker() {
    progress_.unwanted = true;
    stop();
  }

  // Makes code of this generation from now on, and of no other one; once for each. `like`:
  // Generation.
  void start(const Generation& of, const TierOptions& tier, std::optional<MadeCode> like = {});
  // What is not made yet is not made; waits for the POU that is being made.
  void stop();
  // After stop(), once: what it had made, for start() of the version that was built on that one,
  // or that it was built on.
  std::optional<MadeCode> take_stopped();
  void wait() const;
  // Is it at work for this generation, or has it done that last?
  bool is_for(const Generation& generation) const { return for_ == generation.first_code(); }
  // POUs that are still to be made; 0: it is done, or was never started.
  uint32_t to_make() const;
  // Control thread, between scans: what is made takes its place by one store. Executions that are
  // suspended go on with what they began with. With `at` (TierOptions::take_at), not before and at
  // once after that cycle; then no other thread calls anything.
  void take(TaskTables& tables, uint64_t at, uint64_t cycle) const;

 private:
  native::Progress progress_;
  uint32_t pous_ = 0;
  std::shared_ptr<const CodeTable> for_;
  std::optional<ir::VerifiedImage> version_;  // likewise
  std::packaged_task<void()> task_;
  std::optional<pthread_t> thread_;  // a POSIX one: that none can be had is an answer there
  std::shared_future<void> done_;    // invalid: there was no thread
};

}  // namespace vm
