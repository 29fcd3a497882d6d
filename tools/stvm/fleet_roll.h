// The roll-out of an edit by waves (X6-02 to X6-08): a plan is carried out step by step, and each
// step is written down before it is done. What is found on a controller counts more than what the
// plan says of it, so a plan that was left in the middle is gone on with, and nothing is done
// twice.
#pragma once

#include <functional>
#include <mutex>
#include <optional>

#include "tools/stvm/fleet_plan.h"
#include "tools/stvm/fleet_visit.h"
#include "tools/stvm/plan_trace.h"

namespace stvm {

// The world around a roll-out.
struct RollPorts {
  std::function<int64_t()> now_ms;        // since 1970
  std::function<void(int64_t)> pause_ms;  // about so long
  std::function<base::Status(const RollPlan&)> save;
  // Before a wave begins; an error ends the run, and the plan stays as it is.
  std::function<base::Status(const RollPlan&)> may_begin;
  // A line for people.
  std::function<void(const std::string&)> say;
  // A package from what runs to the program before (X8).
  std::function<base::Result<base::Bytes>(const base::Bytes& running, const base::Bytes& before)>
      package_back;
};

class FleetRoll {
 public:
  FleetRoll(RollPlan& plan, const FleetEdit& edit, FleetAccess access, RollPorts ports)
      : plan_(plan), edit_(edit), access_(std::move(access)), ports_(std::move(ports)) {}

  // X6-02: the check of all, before anything is done; nothing is changed. The error names the first
  // that cannot be changed.
  std::vector<FleetRow> check_all() const;
  // Goes on until the plan is over. An error: the plan could not be written, or somebody said no;
  // nothing was done that is not in it.
  base::Status run();
  // Takes back all trials that are open.
  base::Status abort();

 private:
  using Found = PlanTrace;
  using Step = void (FleetRoll::*)(size_t);

  Found look(size_t member) const;
  SwitchOptions how(size_t member) const;
  std::string note(size_t wave) const;
  FleetRow visit_change(size_t member, bool dry_run) const;

  // Under the lock: the decision, written down. False: it could not be, and the run ends.
  bool decide(size_t member, RollState state, const std::string& text = {});
  bool save();
  // `step` for each of these, `parallel` at once.
  void for_each(const std::vector<size_t>& members, uint32_t parallel, Step step);

  base::Status go_on();
  void run_wave();
  void start(size_t member);
  void begin_trial(size_t member);
  void settle(size_t member, const Found& found);
  void watch_trials();
  void watch(size_t member);
  void silent(size_t member);
  void accept_wave(size_t wave);
  void accept(size_t member);
  void end_wave();
  void fail(RollPhase phase, std::string why);
  void undo_open();
  void undo(size_t member);
  void undo_accepted(size_t member);
  bool too_many_failed() const;
  size_t failed_in(size_t wave) const;
  std::vector<size_t> with_state(size_t wave, RollState state) const;

  RollPlan& plan_;
  const FleetEdit& edit_;
  FleetAccess access_;
  RollPorts ports_;
  std::mutex lock_;  // of the plan
  std::optional<base::Error> stopped_;
};

}  // namespace stvm
