// Makes the first version's machine code on a thread in the background (Making::kBeside), so that
// its first scan need not wait for it. The program is interpreted until then, and on when there is
// no room for machine code.
#pragma once

#include <cstdint>
#include <future>

#include "vm/load/generation.h"
#include "vm/native/program.h"
#include "vm/runtime/task_tables.h"

namespace vm {

class NativeMaker {
 public:
  ~NativeMaker();  // stops it; what it makes is lost

  // `first` outlives what this makes: call wait() before anything ends that generation.
  void start(Generation& first, const TierOptions& tier);
  void wait() const;
  // POUs that are still to be made; 0: it is done, or was never started. Any thread.
  uint32_t to_make() const;
  // Control thread, between scans: what is made takes its place by one store. Executions that are
  // suspended go on with what they began with. With `at` (TierOptions::take_at), not before and at
  // once behind that cycle.
  void take(TaskTables& tables, uint64_t at, uint64_t cycle) const;

 private:
  native::Progress progress_;
  uint32_t pous_ = 0;
  std::shared_future<void> done_;
};

}  // namespace vm
