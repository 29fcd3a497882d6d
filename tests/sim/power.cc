// Disks that fail and power that goes: what the simulated plant finds when it comes back.
#include <algorithm>

#include "online_change/store/boot.h"
#include "tests/sim/world.h"

namespace sim {
namespace {

struct PowerCut {};

// Which of the sectors that were not synced have reached the disk, and one of them in part.
SimStorage what_is_left(const SimStorage& disk, differential::Random& random) {
  SimStorage::Choice choice;
  for (const SimStorage::Dirty& dirty : disk.dirty()) {
    choice.push_back(
        static_cast<uint8_t>(random.below(static_cast<uint32_t>(dirty.contents.size() + 1))));
  }
  Tear tear;
  if (!choice.empty() && random.one_in(2)) {
    tear.number = random.below(static_cast<uint32_t>(choice.size()));
    tear.bytes = random.below(kSector);
  }
  return disk.after_cut(choice, tear);
}

// After a power loss (D4).
base::Digest what_boots(const vm::StatusReport& status) {
  return status.last_edit_boots ? status.running : status.boots_next;
}

}  // namespace

void World::boot(const std::optional<ir::VerifiedImage>& given) {
  vm::ControllerOptions options;
  options.fuel_budget = 20'000'000;
  options.on_trap = ir::OnTrap::kStopTask;
  store_ = std::make_unique<online_change::Store>(disk_);
  events_ = std::make_unique<EventCheck>(*store_, clock_);
  base::Result<online_change::Boot> boot =
      online_change::boot(*store_, given, "sim", events_->wall_ns());
  require(boot.ok(), "a program boots");
  options.events = &events_->ring();
  auto controller = vm::Controller::start(boot->image, options, clock_, devices_, boot->retained);
  require(controller.ok(), "the program starts");
  controller_ = std::move(*controller);
  boundary_ = std::make_unique<SteppedBoundary>(*controller_, clock_);
  boundary_->on_switch([this](const Snapshot& a, const Snapshot& b) { switched(a, b); });
  boundary_->on_cycle([this] { remember_retained(); });
  stvm::StartReport start{boot->trial_lost, boot->alarms};
  service_ = std::make_unique<stvm::ControllerService>(
      *controller_, clock_, *store_, *boundary_, start, [this] { return events_->wall_ns(); });
  service_->resume(boot->edits);
  for (const std::string& alarm : boot->alarms) say("  alarm: " + alarm);
  expect_start(*boot);
  check_events();
  remember_retained();
}

void World::remember_retained() {
  ++tally_.boundaries;
  if (controller_->at_boundary() && !controller_->image().retain.empty()) {
    retained_.push_back(retained_values(*controller_));
  }
}

// From here on nothing older comes back.
void World::save() {
  say("save");
  online_change::Snapshot snapshot;
  while (!controller_->at_boundary()) boundary_->cycle();
  service_->keeper().take(snapshot);
  const Values now = retained_values(*controller_);
  base::Status saved = service_->keeper().save(snapshot);
  if (!saved.ok()) return refused(saved.error());
  retained_.assign(1, now);
}

void World::any_operation() {
  switch (random_.below(5)) {
    case 0:
      return save();
    case 1:
      return accept();
    case 2:
      return undo();
    default:
      return change();
  }
}

// What the thread of the keeper does once a second, with the boundary that it waits for.
void World::keeper_round() {
  online_change::RetainKeeper& keeper = service_->keeper();
  keeper.step(clock_.now_ns());
  while (!controller_->at_boundary()) boundary_->cycle();
  keeper.serve(INT64_MAX);
  keeper.step(clock_.now_ns());
}

void World::renew() {
  constexpr int64_t kRoundNs = 1'000'000'000;
  constexpr int kMostRounds = 20;  // the longest wait between two attempts is 8 s
  store_->look();  // what could not be looked at is a complaint until somebody looks again
  for (const std::string& text : store_->complaints()) {
    events_->happened(Event::kAlarm, {}, text);
  }
  if (!store_->complaints().empty()) {
    events_->happened(Event::kCleared, {}, "storage is well again");
  }
  for (int round = 0; round < kMostRounds; ++round) {
    keeper_round();
    const int64_t until_ns = clock_.now_ns() + kRoundNs;
    while (clock_.now_ns() <= until_ns) boundary_->cycle();
    service_->keep_up();
  }
  require(store_->complaints().empty(), "what has failed is renewed when the disk is well");
}

// Calls of the disk fail; in some worlds nobody renews what has failed before the power goes.
void World::disk_fault() {
  const vm::StatusReport before = settled();
  const bool from_now_on = random_.one_in(2);
  const Failure how = random_.one_in(2) ? Failure::kError : Failure::kShort;
  uint32_t calls = random_.below(12);
  say("the disk fails");
  // Whether a record that failed has become durable, nobody knows.
  may_boot_ = {before.boots_next, before.running};
  disk_failed_ = true;
  disk_.fails = [=](std::string_view) mutable {
    if (calls > 0) return --calls, Failure::kNone;
    if (!from_now_on) calls = ~0u;
    return how;
  };
  any_operation();
  disk_.fails = nullptr;
  may_boot_.push_back(settled().running);
  ++tally_.faults;
  if (random_.one_in(2)) return;
  say("  and is renewed");
  renew();  // what was switched or undone meanwhile is stored when it is tried next
  disk_failed_ = false;
}

void World::power_cut() {
  const vm::StatusReport before = settled();
  if (!disk_failed_) may_boot_ = {what_boots(before)};
  const bool inside = !disk_failed_ && random_.one_in(2);
  say(inside ? "power cut inside an operation" : "power cut");
  if (inside) {
    uint32_t calls = random_.below(40);
    disk_.before_call = [=]() mutable {
      if (calls-- == 0) throw PowerCut();
    };
    try {
      any_operation();
      check_events();
      may_boot_ = {what_boots(settled())};
    } catch (const PowerCut&) {
      say("  there it was");
    }
    disk_.before_call = nullptr;
  }
  come_back();
}

void World::come_back() {
  ++tally_.cuts;
  const SimStorage at_cut = disk_;  // what comes after it has never been
  events_->end(*controller_);
  service_.reset();
  boundary_.reset();
  controller_.reset();
  events_.reset();
  store_.reset();
  disk_ = at_cut;
  const std::vector<Values> retained = std::move(retained_);
  retained_.clear();
  for (bool again = true; again;) {
    disk_ = what_is_left(disk_, random_);
    again = random_.one_in(4);
    uint32_t calls = random_.below(20);
    if (again) {
      disk_.before_call = [=]() mutable {
        if (calls-- == 0) throw PowerCut();
      };
    }
    try {
      boot(std::nullopt);
      again = false;
    } catch (const PowerCut&) {
      say("  and again");
      const SimStorage at_next_cut = disk_;
      service_.reset();
      boundary_.reset();
      controller_.reset();
      events_.reset();
      store_.reset();
      disk_ = at_next_cut;
    }
    disk_.before_call = nullptr;
  }
  disk_failed_ = false;
  const Values now = retained_values(*controller_);  // before anything of it runs
  const base::Digest running = controller_->verified().digest();
  say("  boots " + base::short_hex(running));
  require(std::find(may_boot_.begin(), may_boot_.end(), running) != may_boot_.end(),
          "what boots is what was accepted last");
  on_trial_.clear();
  Hand hand = connect();
  const auto edits = hand.client->edits();
  require(edits.ok(), "edits are told");
  for (const stvm::TrialEdit& edit : *edits) on_trial_.push_back({edit.from, std::nullopt});
  edits_ = on_trial_.size();
  if (on_trial_.empty()) require(settled().boots_next == running, "and boots next");
  if (!on_trial_.empty()) {
    require(on_trial_.front().before == settled().boots_next, "the oldest edit is of what boots");
    require(edits->back().to == running, "and the newest one runs");
  }
  const bool known =
      retained.empty() || std::any_of(retained.begin(), retained.end(),
                                      [&](const Values& values) { return agree(now, values); });
  require(known, "the retained values are those of one boundary");
}

}  // namespace sim
