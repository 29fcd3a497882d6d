#include "tests/sim/stepped_boundary.h"

namespace sim {

void SteppedBoundary::cycle() {
  controller_.cycle();
  if (cycled_) cycled_();
}

vm::Boundary::Outcome SteppedBoundary::run(const std::function<void()>& job, int64_t timeout_ns) {
  const int64_t give_up_ns = clock_.now_ns() + timeout_ns;
  const auto due = [&] {
    return !controller_.faulted() && clock_.now_ns() >= controller_.next_cycle_ns();
  };
  while (!controller_.at_boundary() || due()) {
    if (clock_.now_ns() >= give_up_ns) return Outcome::kTimeout;
    cycle();
  }
  const Snapshot before(controller_);
  job();
  if (cycled_) cycled_();
  const Snapshot now(controller_);
  if (before.image().digest() != now.image().digest()) {
    if (switched_) switched_(before, now);
  } else if (!guarded_.empty()) {
    check_untouched(before, now, guarded_);
  }
  return Outcome::kDone;
}

void SteppedBoundary::pause(int64_t ns) {
  const int64_t until_ns = clock_.now_ns() + ns;
  do {
    cycle();
  } while (clock_.now_ns() < until_ns && !controller_.faulted());
}

}  // namespace sim
