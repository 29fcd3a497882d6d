// What a change does in idle time before it is armed or switched (C5, C7).
#include "online_change/apply/pending.h"

namespace online_change {
namespace {

// The next cycle is waited for, to see what the program writes in one.
constexpr int64_t kSoonNs = 100'000'000;

}  // namespace

base::Result<bool> Change::configure() {
  if (state_ != State::kPrepared) return not_in("prepared");
  if (!controller_.at_boundary()) return no_boundary();
  if (!idle_units()) return abandoned("while it was configured");
  pending_->catching_up.cycle = controller_.cycles();
  return units_left() == 0;
}

bool Change::idle_units() {
  bool stop = false;
  controller_.run_idle([&] {
    stop = interrupted();
    return !stop && unit();
  });
  if (stop) abandon();
  return !stop;
}

base::Result<bool> Change::catch_up() {
  if (state_ != State::kPrepared && state_ != State::kArmed) return not_in("prepared");
  if (!controller_.at_boundary()) return no_boundary();
  if (!pending_->area) return true;
  Standby& area = *pending_->area;
  CatchingUp& passes = pending_->catching_up;
  if (area.rests()) {
    // Since the last one began the program has not run; where it seldom does, the switch comes
    // before it does again.
    const bool soon = controller_.base_period_ns() <= kSoonNs;
    if (soon && controller_.cycles() == passes.cycle) return false;
    passes.cycle = controller_.cycles();
    area.begin_pass();
  }
  if (!idle_units()) return abandoned("while it caught up");
  return area.rests() && passes.over(predicted_pause_ns(), admit(false).ok());
}

// In place version 1 owns none of the bytes that are written here, and a second area is not its own
// either, so there is nothing to take back. False: nothing was left.
bool Change::unit() {
  uint8_t* memory = controller_.memory().data();
  if (pending_->area) return pending_->area->unit(memory);
  const std::vector<Piece>& pieces = pending_->early.pieces();
  if (pending_->early_done == pieces.size()) return false;
  return pending_->early.move(pieces[pending_->early_done++], memory, memory, nullptr);
}

bool Change::late_unit() {
  if (pending_->area && pending_->area->is_made()) return false;  // close() does what is left
  const bool done = unit();
  if (done) controller_.worked(vm::kIdleUnitNs);
  return done;
}

uint64_t Change::units_left() const {
  if (!pending_) return 0;
  if (pending_->area) return pending_->area->units_left();
  return pending_->early.pieces().size() - pending_->early_done;
}

}  // namespace online_change
