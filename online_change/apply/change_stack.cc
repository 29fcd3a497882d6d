// The edits on trial as a stack (D3, docs/adr/0034-edits-on-trial.md): the newest one is pending_,
// those that it was made on rest below it. Each keeps what it needs to go back, but for the
// generation of the version before: a POU has two code slots, so only one version beside the
// running one is ready to run. That of the newest edit is made again when one above it has gone.
#include <algorithm>

#include "base/check.h"
#include "base/memory_limit.h"
#include "base/tool_limits.h"
#include "online_change/apply/pending.h"

namespace online_change {

base::Error Change::not_primed() {
  return {base::Refusal::kBusy, "the version before is still being made ready; try again"};
}

base::Status Change::room() const {
  if (on_trial() < base::kMostEditsOnTrial) return base::Ok{};
  return base::Error{base::Refusal::kTooMany,
                     std::to_string(on_trial()) +
                         " edits are on trial, and no more can be (kMostEditsOnTrial); accept or "
                         "undo some first"};
}

base::Status Change::accept() { return accept_oldest(on_trial()); }

base::Status Change::accept_oldest(size_t edits) {
  if (on_trial() == 0) {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to accept"};
  }
  const size_t resting = std::min(edits, below_.size());
  const bool newest = state_ == State::kTrial && edits >= on_trial();
  below_.erase(below_.begin(), below_.begin() + static_cast<std::ptrdiff_t>(resting));
  if (!newest) return base::Ok{};
  retired_ = std::move(pending_->waiting);
  retired_area_ = std::move(pending_->area);
  retired_pending_ = std::move(pending_);
  state_ = State::kIdle;
  return base::Ok{};
}

base::Status Change::prime() {
  if (state_ != State::kTrial || pending_->waiting) return base::Ok{};
  const auto again = [&]() -> base::Status {
    base::Result<std::unique_ptr<vm::Generation>> before = controller_.prepare(pending_->old_image);
    if (!before.ok()) return before.error();
    pending_->waiting = std::move(*before);
    retired_.reset();
    if (pending_->migrate_back) pending_->migrate_back->run_by(controller_.generation());
    return base::Ok{};
  };
  return base::within_memory(again, [] {
    return base::Status(base::Error{base::Refusal::kNoMemory, {}});
  });
}

// The newest edit on trial, while another one is prepared on top of it. By standby it reads what it
// will need of the old data area now: no area is kept but that of the newest one.
void Change::rest() {
  if (pending_->area) {
    base::check(pending_->backward.remember(pending_->area->data().data(), {}),
                "nothing interrupts what is remembered");
    pending_->area.reset();
  }
  below_.push_back(std::move(pending_));
  state_ = State::kIdle;
}

// What rested is the newest one again.
void Change::resume() {
  if (below_.empty()) return;
  pending_ = std::move(below_.back());
  below_.pop_back();
  state_ = State::kTrial;
}

}  // namespace online_change
