// What a Change holds from stage() to accept(), undo() or cancel(): both versions, the plans, and
// everything that carries them out. All memory is allocated here, before the boundary.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "ir/bytecode/renames.h"
#include "online_change/apply/change.h"
#include "online_change/apply/charts.h"
#include "online_change/apply/handle_transfer.h"
#include "online_change/apply/kept_data.h"
#include "online_change/apply/leaving.h"
#include "online_change/apply/lost_places.h"
#include "online_change/apply/migrator.h"
#include "online_change/apply/standby.h"
#include "online_change/apply/transfer.h"
#include "online_change/apply/used_data.h"
#include "online_change/plan/pause.h"
#include "vm/load/left_outputs.h"

namespace online_change {

// Only measures; nothing that runs depends on it.
inline int64_t measured_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// Without it, start code would find nothing to do.
inline bool does_anything(const Plan& plan) {
  return !plan.steps.empty() || plan.counts.dropped != 0;
}

// Standby: passes after the first copy, until what they leave for the boundary fits.
struct CatchingUp {
  // So many in turn that bring nothing, and more would not either.
  static constexpr int kMostInVain = 4;
  uint64_t cycle = 0;            // in which the last one began
  int64_t least_ns = INT64_MAX;  // pause, of the best one
  int in_vain = 0;
  // After a pass: true when more are of no use.
  bool over(int64_t pause_ns, bool fits) {
    // A gain of less than an eighth is none: each program writes now more, now less.
    in_vain = pause_ns < least_ns - least_ns / 8 ? 0 : in_vain + 1;
    least_ns = std::min(least_ns, pause_ns);
    return fits || in_vain >= kMostInVain;
  }
};

struct Change::Pending {
  // `same`: they have the same_data().
  Pending(Package received, ir::VerifiedImage running, ir::VerifiedImage next, Strategy chosen,
          bool same)
      : strategy(chosen),
        keeps_all(same && leaves_all(received)),
        package(std::move(received)),
        old_image(std::move(running)),
        new_image(std::move(next)),
        renamed(old_image.image(), new_image.image()),
        forward(package.forward, old(), new_image.image(),
                in_place() ? Transfer::Steps::kBoundary : Transfer::Steps::kApart),
        early(package.forward, old(), new_image.image(), Transfer::Steps::kEarly),
        backward(package.inverse, new_image.image(), old(), Transfer::Steps::kAll),
        handles(same ? HandleTransfer(old()) : HandleTransfer(old(), new_image.image())),
        leaving(find_leaving(old(), new_image.image())),
        charts(same && same_nets(old(), new_image.image()) ? Charts()
                                                           : Charts(old(), new_image.image())),
        lost(lost_places(package.forward, old(), new_image.image())),
        left(vm::left_outputs({old(), old_image.running_pous()},
                              {new_image.image(), new_image.running_pous()})) {}
  // After stage(): both are known.
  void count_work(const ir::Bools& bools) {
    if (keeps_all) {
      switch_work.values = bools_to_normalise(bools, waiting->bools());
      undo_work.values = bools_to_normalise(waiting->bools(), bools);
      if (area) switch_work.compared = switch_work.copied = area->compared_bytes();
      return;
    }
    starts = start_code_runs(package.forward, new_image.image(), leaving);
    if ((starts && in_place()) || !leaving.at_switch.empty()) kept.emplace(old());
    switch_work = in_place() ? in_place_work()
                             : boundary_work(package.forward, old(), new_image.image(), true);
    if (area) {
      switch_work.compared = area->compared_bytes();
      switch_work.copied = area->compared_bytes() + kept_bytes();
    }
    count_undo_work();
  }
  void count_undo_work() {
    undo_work = boundary_work(package.inverse, new_image.image(), old(), true);
    if (!leaving.at_undo.empty()) undo_work.copied = total_bytes(used_extents(new_image.image()));
  }
  uint64_t kept_bytes() const { return kept ? kept->size() : 0; }
  // Standby: `done` or found in the area, with what is done outside of it.
  BoundaryWork of_switch(BoundaryWork done) const {
    done.references = switch_work.references;
    done.calls = switch_work.calls;
    done.copied += kept_bytes();
    return done;
  }
  BoundaryWork in_place_work() const {
    BoundaryWork work = boundary_work(package.forward, old(), new_image.image(), false);
    const bool keeps = starts || !leaving.at_switch.empty();
    if (keeps) work.copied = total_bytes(used_extents(old()));
    return work;
  }
  // What the step out of this state keeps of the values before it.
  std::optional<KeptData>& kept_at(State state) {
    return state == State::kTrial ? kept_back : kept;
  }
  bool in_place() const { return strategy == Strategy::kInPlace; }
  // Version 1 under the names of version 2.
  const ir::Image& old() const { return renamed.image(); }

  Strategy strategy;
  bool keeps_all;  // the change is one of code alone
  Package package;
  ir::VerifiedImage old_image;
  ir::VerifiedImage new_image;
  ir::OldUnderNewNames renamed;
  Transfer forward;
  Transfer early;  // in place
  size_t early_done = 0;
  Transfer backward;
  HandleTransfer handles;
  std::unique_ptr<Migrator> migrate;  // null: nothing migrates
  std::unique_ptr<Migrator> migrate_back;
  // Version 2 until the switch, version 1 in trial; null: Change::prime() makes it again.
  std::unique_ptr<vm::Generation> waiting;
  // Standby: its data. In trial that is version 1's, as the switch found it, until another edit is
  // prepared.
  std::unique_ptr<Standby> area;
  CatchingUp catching_up;
  bool starts = false;  // start_code_runs()
  // In place where it does, and where FB_Exit runs in the switch; until that is made.
  std::optional<KeptData> kept;
  std::optional<KeptData> kept_back;  // where FB_Exit runs in the undo; taken by prime()
  // Most of what the switch and undo have to do, without the loops of migrations.
  BoundaryWork switch_work;
  BoundaryWork undo_work;
  Leaving leaving;
  Charts charts;
  LostPlaces lost;
  std::vector<vm::LeftOutput> left;
  vm::ForceList ended_forces;  // by the switch
  bool allow_loss = false;
  // What the last report said would be lost: with leave for that, nothing else may be (X1).
  bool reported = false;
  std::vector<std::pair<uint32_t, uint32_t>> shown;  // step and index, sorted
  bool may_lose(const Loss& loss) const {
    if (!allow_loss || !reported) return allow_loss;
    return std::binary_search(shown.begin(), shown.end(), std::pair(loss.step, loss.index));
  }
};

}  // namespace online_change
