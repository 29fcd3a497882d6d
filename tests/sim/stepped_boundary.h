// Boundaries of a controller that runs in the same thread: whoever waits for one makes the cycles
// happen that lead to it. Every job is looked at from outside.
#pragma once

#include <functional>

#include "tests/sim/laws.h"
#include "vm/runtime/boundary.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace sim {

class SteppedBoundary : public vm::Boundary {
 public:
  SteppedBoundary(vm::Controller& controller, vm::Clock& clock)
      : controller_(controller), clock_(clock) {}

  Outcome run(const std::function<void()>& job, int64_t timeout_ns) override;
  void pause(int64_t ns) override;

  // Called around a job when the program behind it is another one.
  using Switched = std::function<void(const Snapshot& before, const Snapshot& now)>;
  void on_switch(Switched switched) { switched_ = std::move(switched); }
  // Called after each cycle and each job.
  void on_cycle(std::function<void()> cycled) { cycled_ = std::move(cycled); }
  // While set, a job that does not switch may change no value.
  void guard(std::string what) { guarded_ = std::move(what); }
  void cycle();

 private:
  vm::Controller& controller_;
  vm::Clock& clock_;
  Switched switched_;
  std::function<void()> cycled_;
  std::string guarded_;
};

}  // namespace sim
