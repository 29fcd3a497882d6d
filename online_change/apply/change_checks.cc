// What is known of a change before it is armed, and what speaks against it.
#include <algorithm>
#include <optional>

#include "online_change/apply/losses.h"
#include "online_change/apply/pending.h"
#include "online_change/plan/pause.h"

namespace online_change {
namespace {

// So much is copied at one boundary.
constexpr size_t kGatherBytes = 128u << 10;

}  // namespace

// On a copy of what they read of the live data: whether migrations trap or do not end is known now,
// and what they give is what the switch will write if their inputs stay as they are. A migration
// reads one instance, and that is copied at one boundary; instances are independent of each other.
base::Status Change::try_migrations(const AtBoundary& at_boundary) {
  Pending& change = *pending_;
  const ir::Image& next = change.new_image.image();
  auto there = Migrator::make(change.package.forward, change.old(), next, *change.waiting);
  if (!there.ok()) return there.error();
  auto back = Migrator::make(change.package.inverse, next, change.old(), *change.waiting);
  if (!back.ok()) return back.error();
  change.migrate = std::move(*there);
  change.migrate_back = std::move(*back);
  if (!change.migrate) return base::Ok{};
  Migrator& migrate = *change.migrate;
  for (size_t call = 0; call < migrate.calls();) {
    const auto gather = [&] {
      call = migrate.gather(call, kGatherBytes, controller_.memory().data());
      controller_.worked(int64_t{kGatherBytes} / kPauseComparedBytesPerNs);
    };
    base::Status taken = base::Ok{};
    if (at_boundary) {
      taken = at_boundary(gather);
    } else {
      gather();
    }
    if (!taken.ok()) return taken;
  }
  return migrate.run_gathered();
}

int64_t Change::predicted_pause_ns() const {
  if (!pending_) return 0;
  const bool back = state_ == State::kTrial;
  BoundaryWork work = back ? pending_->undo_work : pending_->switch_work;
  const bool known = !back && pending_->area && pending_->area->passes() != 0;
  if (known) work = pending_->of_switch(pending_->area->found());
  const Migrator* migrate = back ? pending_->migrate_back.get() : pending_->migrate.get();
  if (migrate != nullptr) work.loops = migrate->fuel_used();
  return paced(pause_ns(work));
}

int64_t Change::paced(int64_t model_ns) const {
  return static_cast<int64_t>(pace_ * static_cast<double>(model_ns));
}

// Virtual time passes for what has been done. In place that is all there was to do; by standby,
// what has drifted since the copy.
void Change::count_switch() {
  BoundaryWork work = pending_->switch_work;
  if (pending_->area) work = pending_->of_switch(pending_->area->work());
  if (pending_->migrate) work.loops = pending_->migrate->last_fuel();
  controller_.worked(pause_ns(work));
}

void Change::count_undo() {
  BoundaryWork work = pending_->undo_work;
  if (pending_->migrate_back) work.loops = pending_->migrate_back->last_fuel();
  controller_.worked(pause_ns(work));
}

const vm::ForcedSet& Change::next_forces() const {
  return controller_.next_forces(*pending_->waiting);
}

std::vector<ir::DataRange> Change::looked_at() const {
  if (!pending_) return {};
  if (!pending_->keeps_all) return {{0, controller_.image().data_capacity}};
  std::vector<ir::DataRange> ranges;
  for (const vm::LeftOutput& output : pending_->left) {
    ranges.push_back({output.symbol.data, pending_->old().layouts[output.symbol.type].size});
  }
  return ranges;
}

uint64_t Change::count_losses(std::span<const uint8_t> memory) const {
  std::vector<LiveLoss> none;
  return pending_ && state_ != State::kTrial ? find_losses(memory, 0, none) : 0;
}

std::vector<LiveLoss> Change::live_losses() const {
  return live_losses(controller_.memory().view());
}

std::vector<LiveLoss> Change::live_losses(std::span<const uint8_t> memory) const {
  std::vector<LiveLoss> rows;
  if (!pending_ || state_ == State::kTrial) return rows;
  pending_->shown.clear();
  pending_->reported = true;
  pending_->forward.losses(memory.data(), [&](const Loss& loss) {
    pending_->shown.push_back({loss.step, loss.index});
    return true;
  });
  std::sort(pending_->shown.begin(), pending_->shown.end());
  find_losses(memory, kMostLosses, rows);
  put_initial_last(rows, pending_->old());
  return rows;
}

uint64_t Change::find_losses(std::span<const uint8_t> memory, size_t most,
                             std::vector<LiveLoss>& rows) const {
  uint64_t count = 0;
  // Made when there is something to tell.
  std::optional<Areas> areas;
  std::optional<Areas> old_areas;
  pending_->forward.losses(memory.data(), [&](const Loss& loss) {
    if (count++ < most) {
      if (!areas) areas.emplace(pending_->new_image.image());
      rows.push_back(describe(loss, pending_->forward, *areas, memory.data()));
    }
    return true;
  });
  count += describe_lost(pending_->lost, pending_->old(), pending_->new_image.image(), memory, most,
                         rows);
  pending_->handles.for_each_broken(memory.data(), [&](uint32_t at, ir::TypeId type) {
    if (count++ >= most) return;
    if (!old_areas) old_areas.emplace(pending_->old());
    rows.push_back(describe_broken(*old_areas, at, type, memory));
  });
  for (const vm::LeftOutput& output : pending_->left) {
    if (!is_on(pending_->old(), output, memory)) continue;
    if (count++ < most) rows.push_back(describe_left(output, pending_->old(), memory));
  }
  const vm::ForceList& ended = next_forces().moved.ended;
  if (ended == nullptr) return count;
  for (const vm::Force& force : *ended) {
    if (count++ < most) rows.push_back({force.path, "forced", "", "loses its force"});
  }
  return count;
}

// Not a matter of losses: the chart would begin again, whatever it was in the middle of.
base::Status Change::check_charts() const {
  std::string why = pending_->charts.stuck(controller_.memory().data());
  if (why.empty()) return base::Ok{};
  return base::Error{base::Refusal::kActiveStepGone, std::move(why)};
}

base::Status Change::check_losses(bool allow_loss) const {
  if (allow_loss) return base::Ok{};
  std::vector<LiveLoss> first;
  const uint64_t count = find_losses(controller_.memory().view(), 1, first);
  if (count == 0) return base::Ok{};
  return would_lose(first.front(), count - 1);
}

base::Status Change::refused_by_values(bool allow_loss) const {
  if (state_ != State::kPrepared) {
    return base::Error{base::Refusal::kBusy, "no change is staged"};
  }
  base::Status going_on = check_charts();
  return going_on.ok() ? check_losses(allow_loss) : going_on;
}

// The other strategy may help: by standby nothing is kept aside for what FB_Init may write; in
// place nothing is brought up to date that the program rewrites.
std::string Change::way_out() const {
  if (pending_->kept) {
    const bool leaves = !pending_->leaving.at_switch.empty();
    BoundaryWork keeping;
    keeping.copied = pending_->kept_bytes();
    return "; " + std::to_string(paced(pause_ns(keeping) - kPauseFixedNs)) +
           " ns of it are for keeping all values, as " + (leaves ? "FB_Exit" : "FB_Init") +
           " runs in the switch" +
           (leaves ? "" : "; --strategy standby needs no copy of them there");
  }
  if (!pending_->area) return {};
  const BoundaryWork in_place = pending_->in_place_work();
  const Standby& area = *pending_->area;
  std::string text = "; by standby ";
  if (area.passes() == 0) {
    text += "all of its " + std::to_string(area.compared_bytes()) + " bytes of data are expected ";
  } else {
    text += std::to_string(area.found().copied) + " of its " +
            std::to_string(area.compared_bytes()) + " bytes of data are found ";
  }
  return text + "to have been written since they were copied; in place (--strategy in-place) the " +
         "switch is expected to take " + std::to_string(paced(pause_ns(in_place))) + " ns";
}

base::Status Change::admit(bool allow_overrun) const {
  if (allow_overrun) return base::Ok{};
  base::Status fits = fits_free_time(predicted_pause_ns(), controller_.tasks());
  if (fits.ok()) return fits;
  return base::Error{fits.error().refusal, fits.error().text + way_out()};
}

base::Status fits_free_time(int64_t pause_ns, const std::vector<vm::TaskStatus>& tasks) {
  for (const vm::TaskStatus& task : tasks) {
    if (task.stopped || task.period_ns == 0) continue;  // events leave as much time as there is
    const int64_t free_ns = std::max<int64_t>(task.period_ns - task.recent_ns, 0);
    if (with_reserve(pause_ns) <= free_ns) continue;
    return base::Error{base::Refusal::kPauseTooLong,
                       "the switch is expected to take " + std::to_string(pause_ns) +
                           " ns, and half as much is kept in reserve; task `" + task.name +
                           "` leaves " + std::to_string(free_ns) + " of " +
                           std::to_string(task.period_ns) + " ns, by the longest of its last " +
                           "scans; split the change, or allow it with --allow-overrun"};
  }
  return base::Ok{};
}

}  // namespace online_change
