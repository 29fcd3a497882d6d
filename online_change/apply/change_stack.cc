// The edits on trial as a stack (D3, docs/adr/0034-edits-on-trial.md): the newest one is pending_,
// those that it was made on rest below it. Each keeps what it needs to go back, but for the
// generation of the version before: a POU has two code slots, so only one version beside the
// running one is ready to run. That of the newest edit is made again when one above it has gone.
#include <algorithm>

#include "base/check.h"
#include "base/memory_limit.h"
#include "base/tool_limits.h"
#include "online_change/apply/pending.h"
#include "online_change/apply/values_back.h"

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

std::span<const uint32_t> Change::leaving() const {
  if (state_ != State::kTrial) return {};
  return pending_->leaving.at_undo;
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
  if (state_ != State::kTrial) return base::Ok{};
  const bool leaves = !pending_->leaving.at_undo.empty();
  if (pending_->waiting && (!leaves || pending_->kept_back)) return base::Ok{};
  const auto again = [&]() -> base::Status {
    if (leaves && !pending_->kept_back) pending_->kept_back.emplace(pending_->new_image.image());
    if (pending_->waiting) return base::Ok{};
    auto before = controller_.prepare(pending_->old_image, pending_->ended_forces);
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
  pending_->kept_back.reset();
  below_.push_back(std::move(pending_));
  state_ = State::kIdle;
}

// Of an edit that rests: another one was made on it.
void Change::give_back(Plan& forward, const ir::Image& next, TakenOut taken_out) const {
  const auto& resting = taken_out.change->below_;
  if (taken_out.edit >= resting.size()) return;
  const Pending& edit = *resting[taken_out.edit];
  TakenEdit taken{edit.forward, edit.backward, edit.old_image.image(), edit.new_image.image(), {}};
  for (size_t i = taken_out.edit + 1; i < resting.size(); ++i) {
    taken.later.push_back(&resting[i]->new_image.image());
  }
  taken.later.push_back(&controller_.image());
  put_values_back(forward, next, taken);
}

// What rested is the newest one again.
void Change::resume() {
  if (below_.empty()) return;
  pending_ = std::move(below_.back());
  below_.pop_back();
  state_ = State::kTrial;
}

}  // namespace online_change
