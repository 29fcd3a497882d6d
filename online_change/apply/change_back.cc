// The way back of an edit on trial: undo, and what it would do, in a copy of the data.
#include "base/check.h"
#include "online_change/apply/losses.h"
#include "online_change/apply/pending.h"

namespace online_change {

base::Result<SwitchReport> Change::undo(Exits exits, Losses losses) {
  return guarded([&] { return undo_steps(exits, losses); });
}

base::Result<SwitchReport> Change::undo_steps(Exits exits, Losses losses, bool whatever_happens) {
  if (state_ != State::kTrial) {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to undo"};
  }
  if (!controller_.at_boundary()) return no_boundary();
  const bool leaves = !pending_->leaving.at_undo.empty() && exits == Exits::kRun;
  if (!pending_->waiting || (leaves && !pending_->kept_back)) return not_primed();
  SwitchReport report = report_begin();
  uint8_t* memory = controller_.memory().data();
  const std::string gone = pending_->charts.lost_on_the_way_back(memory);
  if (!gone.empty() && !whatever_happens) {
    return base::Error{base::Refusal::kActiveStepGone, gone};
  }
  int64_t begin_ns = measured_ns();
  Transfer& back = pending_->backward;
  base::Status left = base::Ok{};
  if (leaves) left = leave(pending_->leaving.at_undo);
  if (left.ok() && pending_->migrate_back) left = pending_->migrate_back->run(memory);
  if (!left.ok() && !whatever_happens) {
    put_back_kept();
    return left.error();
  }
  const bool led_back = pending_->handles.back(memory, interrupted_);
  const bool remembered =
      !pending_->area || back.remember(pending_->area->data().data(), interrupted_);
  count_undo();
  std::optional<base::Error> lost;
  // Handed on by reference: as a copy it would be allocated here.
  const auto on_loss = [&](const Loss& loss) {
    if (losses == Losses::kAllowed) return true;
    const Areas before(pending_->old_image.image());
    lost = would_lose(describe(loss, back, before, memory), 0);
    return false;
  };
  bool done = led_back && remembered &&
              back.read_back(memory, pending_->forward, std::cref(on_loss), interrupted_) &&
              back.save(memory, interrupted_) && back.write(memory, interrupted_);
  if (!done) {
    if (led_back) pending_->handles.restore(memory);
    put_back_kept();
    if (lost) return *lost;
    return base::Error{base::Refusal::kDeadline, "the undo was abandoned; the trial goes on"};
  }
  pending_->charts.settle(memory);
  retired_ = controller_.publish(std::move(pending_->waiting));
  moved_forces_ = controller_.take_moved_forces();
  if (does_anything(pending_->package.inverse)) controller_.construct();
  report.pause_ns = measured_ns() - begin_ns;
  report.counts = pending_->package.inverse.counts;
  retired_area_ = std::move(pending_->area);
  retired_pending_ = std::move(pending_);
  state_ = State::kIdle;
  resume();
  return report;
}

Change::Pending& Change::on_trial_at(size_t below) const {
  base::check(state_ == State::kTrial && below <= below_.size(), "an edit that is on trial");
  return below == 0 ? *pending_ : *below_[below_.size() - below];
}

Change::WayBack Change::way_back(size_t below) const {
  const Pending& edit = on_trial_at(below);
  BoundaryWork work = edit.undo_work;
  if (edit.migrate_back) work.loops = edit.migrate_back->fuel_used();
  return {edit.package.inverse, edit.new_image, edit.old_image, paced(pause_ns(work)),
          edit.leaving.at_undo};
}

// The buffers of the way back are free until undo() itself fills them.
Change::ImaginedUndo Change::imagine_undo(size_t below, uint8_t* memory) {
  Pending& edit = on_trial_at(below);
  ImaginedUndo out;
  if (edit.keeps_all) return out;
  // What it cannot do, the undo says.
  if (below == 0 && edit.migrate_back) (void)edit.migrate_back->run(memory).ok();
  (void)edit.handles.back(memory, {});
  if (edit.area) (void)edit.backward.remember(edit.area->data().data(), {});
  std::optional<Areas> before;
  const OnLoss tell = [&](const Loss& loss) {
    if (out.loss_count++ < kMostLosses) {
      if (!before) before.emplace(edit.old_image.image());
      out.losses.push_back(describe(loss, edit.backward, *before, memory));
    }
    return true;
  };
  (void)edit.backward.read_back(memory, edit.forward, tell, {});
  (void)edit.backward.write(memory, {});
  edit.charts.settle(memory);
  return out;
}

}  // namespace online_change
