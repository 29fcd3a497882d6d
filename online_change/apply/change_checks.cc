// What is known of a change before it is armed, and what speaks against it.
#include <algorithm>

#include "online_change/apply/losses.h"
#include "online_change/apply/pending.h"
#include "online_change/plan/pause.h"

namespace online_change {

int64_t Change::predicted_pause_ns() const {
  if (!pending_) return 0;
  const uint64_t loops = pending_->migrate ? pending_->migrate->fuel_used() : 0;
  const int64_t migrations = static_cast<int64_t>(loops) * kPauseLoopNs;
  if (pending_->in_place()) return plan().predicted_pause_ns + migrations;
  if (!pending_->area) return 0;
  return migrations + predicted_standby_pause_ns(plan(), pending_->old(),
                                                 pending_->new_image.image(),
                                                 pending_->area->compared_bytes());
}

std::vector<LiveLoss> Change::live_losses() const {
  std::vector<LiveLoss> rows;
  if (!pending_ || state_ == State::kTrial) return rows;
  const uint8_t* memory = controller_.memory().data();
  Areas areas(pending_->new_image.image());
  pending_->reported = true;
  pending_->shown.clear();
  auto collect = [&](const Loss& loss) {
    rows.push_back(describe(loss, pending_->forward, areas, memory));
    pending_->shown.push_back({loss.step, loss.index});
    return true;
  };
  pending_->forward.losses(memory, collect);
  std::sort(pending_->shown.begin(), pending_->shown.end());
  std::vector<LiveLoss> others =
      values_without_place(plan(), pending_->old(), controller_.memory().view());
  rows.insert(rows.end(), others.begin(), others.end());
  const ir::Image& old_image = pending_->old();
  Areas old_areas(old_image);
  pending_->handles.for_each_broken(memory, [&](uint32_t at, ir::TypeId type) {
    rows.push_back(describe_broken(old_areas, at, type, controller_.memory().view()));
  });
  for (const std::string& path : controller_.ended_forces(*pending_->waiting)) {
    rows.push_back({path, "forced", "", "loses its force"});
  }
  return rows;
}

// Not a matter of losses: the chart would begin again, whatever it was in the middle of.
base::Status Change::check_charts() const {
  const std::string step = pending_->charts.deserted(controller_.memory().data());
  if (step.empty()) return base::Ok{};
  const std::string name = step.substr(step.rfind('.') + 1);
  return base::Error{base::Refusal::kActiveStepGone,
                     "`" + step + "` is active; wait until it is left, or write " +
                         "{renamed from := '" + name + "'} before the step that goes on for it"};
}

base::Status Change::check_losses(bool allow_loss) const {
  if (allow_loss) return base::Ok{};
  std::vector<LiveLoss> losses = live_losses();
  if (losses.empty()) return base::Ok{};
  return would_lose(losses.front(), losses.size() - 1);
}

// Free time of a task: its period without its longest scan.
base::Status Change::check_pause(bool allow_overrun) const {
  if (allow_overrun) return base::Ok{};
  const int64_t pause_ns = predicted_pause_ns();
  for (const vm::TaskStatus& task : controller_.tasks()) {
    if (task.stopped || task.period_ns == 0) continue;  // events leave as much time as there is
    int64_t free_ns = task.period_ns - task.max_ns;
    if (pause_ns <= free_ns) continue;
    return base::Error{base::Refusal::kPauseTooLong,
                       "the switch is expected to take " + std::to_string(pause_ns) +
                           " ns; task `" + task.name + "` leaves " + std::to_string(free_ns) +
                           " ns; split the change, or allow it with --allow-overrun"};
  }
  return base::Ok{};
}

}  // namespace online_change
