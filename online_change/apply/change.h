// One change on a running controller, as a state machine (docs/ARCHITECTURE.md,
// "How a change goes"). Everything up to kArmed happens while version 1 runs; the switch is one
// call at a boundary; any failure before it leaves version 1 as it was.
//
// Several edits can be on trial, each made on top of the one before it: a stack, each with its own
// way back (docs/adr/0034-edits-on-trial.md). What is said of "the trial" is of the newest one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/value_ranges.h"
#include "online_change/package/package.h"
#include "vm/runtime/controller.h"

namespace online_change {

// How a change gets data memory into version 2's state; what comes of it is the same
// (docs/adr/0011-two-strategies.md).
enum class Strategy : uint8_t {
  kInPlace,  // A: nothing is copied that keeps its place and type
  kStandby,  // C: a second data area is prepared in idle time, and the two change roles
};

enum class State : uint8_t { kIdle, kStaged, kVerified, kPlanned, kPrepared, kArmed, kTrial };
const char* state_name(State state);

inline constexpr size_t kMostLosses = 100'000;  // that are described

struct LiveLoss {  // a value that the change would not carry over exactly
  std::string path;
  std::string old_value;
  std::string new_value;
  std::string what;  // "saturates", "truncates", "inexact"
};

struct SwitchReport {
  uint64_t cycle_before = 0;  // last cycle of the old version
  uint64_t cycle_after = 0;   // first cycle of the new version
  int64_t pause_ns = 0;       // measured, boundary work only
  uint64_t missed = 0;        // releases, because of it; counted by who runs the next cycles
  FateCounts counts;          // what was done
  int64_t ago_ns = 0;         // that it was, when a controller said so
};

// What an undo does with FB_Exit of what goes with it.
enum class Exits : uint8_t {
  kRun,
  kSkip,  // for one that traps whatever happens: it would keep the edit on trial for ever
};

// What an undo does where a value, written since the change, fits its old type only with a loss.
enum class Losses : uint8_t { kRefused, kAllowed };

// Runs a job at a boundary and waits for its end.
using AtBoundary = std::function<base::Status(const std::function<void()>& job)>;

struct Loss;
class Standby;

// kPauseTooLong when a task has less free time than the pause with_reserve(): its period without
// the longest of its last scans.
base::Status fits_free_time(int64_t pause_ns, const std::vector<vm::TaskStatus>& tasks);

class Change;
// An edit on trial that is taken out from below others; `change` null: none.
struct TakenOut {
  const Change* change = nullptr;  // whose edits they are; that of a rehearsal is another one
  size_t edit = 0;                 // its number, from the oldest
};

class Change {
 public:
  explicit Change(vm::Controller& controller);
  ~Change();

  State state() const { return state_; }
  // Is one being prepared, from kStaged to kArmed?
  bool prepares() const { return state_ != State::kIdle && state_ != State::kTrial; }
  // Edits on trial, also while another one is prepared on top of them.
  size_t on_trial() const { return below_.size() + (state_ == State::kTrial ? 1 : 0); }
  // kTooMany: no other edit may be put on top of those that are on trial.
  base::Status room() const;
  // Idle or Trial -> Prepared, in steps, while version 1 runs. What it must know of live data it
  // copies in jobs for `at_boundary`, each of some tens of microseconds; without, the caller is at
  // a boundary. `taken_out`: the edit on trial whose work this one takes back (D3): variables that
  // it had taken away or converted come back with their values (X4).
  base::Status stage(base::ByteSpan package, Strategy strategy = Strategy::kInPlace,
                     const AtBoundary& at_boundary = {}, TakenOut taken_out = {});
  // Values that would be lost if the switch came now; by kPrepared, at a boundary.
  std::vector<LiveLoss> live_losses() const;
  // The losses in a copy of data memory, at any time: what a report shows, kMostLosses of them.
  // `allow_loss` permits exactly those that were there then (arm()).
  std::vector<LiveLoss> live_losses(std::span<const uint8_t> memory) const;
  uint64_t count_losses(std::span<const uint8_t> memory) const;
  const Plan& plan() const;
  // The version that is staged; null: none is.
  const ir::VerifiedImage* next() const;
  // What becomes of the forces by the switch; in trial, by undo.
  const vm::ForcedSet& next_forces() const;
  // After a switch or an undo, once: what it did to forces.
  vm::MovedForces take_moved_forces() { return std::exchange(moved_forces_, {}); }
  // Only code differs: no value is touched, there and back.
  bool keeps_all() const;
  // What live_losses() reads of data memory.
  std::vector<ir::DataRange> looked_at() const;
  Strategy strategy() const;
  // The pause of the switch; in trial, that of undo. It is that of this machine, if set_pace() has
  // been told of it.
  int64_t predicted_pause_ns() const;
  // By kPrepared, at a boundary: work that must be done before the switch, as far as idle time goes
  // (C5). In place: new variables in bytes that version 1 does not use get their initial values
  // (A19); standby: the second data area. True: all is done.
  base::Result<bool> configure();
  uint64_t units_left() const;  // of that work
  // Standby, by kPrepared and kArmed, at a boundary and after configure(): copies again, in idle
  // time, what the program has written meanwhile, pass by pass, each begun in another cycle (C7).
  // True: what is left fits the free time of the tightest task, or more passes would not make it
  // less. In place: true.
  base::Result<bool> catch_up();
  // kPauseTooLong when the predicted pause, with_reserve(), is longer than the free time of the
  // tightest task.
  base::Status admit(bool allow_overrun) const;
  // By kPrepared, at a boundary: what arm() would refuse with these values, but for time. Changes
  // nothing (case 78).
  base::Status refused_by_values(bool allow_loss) const;
  // Prepared -> Armed. Losses are refused unless allowed (kWouldLose), and so is a predicted pause
  // longer than the free time of the tightest task (kPauseTooLong). What configure() left is done.
  base::Status arm(bool allow_loss, bool allow_overrun = false);
  // At a boundary: Armed -> Trial. Re-checks losses; on failure -> Idle, version 1 untouched. When
  // FB_Init of what is new traps (kInitFailed), the switch is undone before any task has run.
  // kBusy, and still kArmed, while start code of version 1 has yet to run, behind a restart.
  // `again`: standby, a deadline that comes while what was written is brought up to date leaves it
  // kArmed, for a later boundary.
  base::Result<SwitchReport> switch_now(bool again = false);
  // At the start of a controller, at a boundary: what runs is on trial since another process (D4).
  // Called for each edit, oldest first, the last one of which has made what runs; `retained` of
  // `before`, when it was switched. Its way back is the one that a switch with these values, and
  // otherwise with those of a cold start, would have noted. After it: prime().
  base::Status adopt(base::ByteSpan package, const ir::VerifiedImage& before,
                     const ir::VerifiedImage& after, base::ByteSpan retained);
  // Trial -> Idle with version 2 for good, and all that it was made on.
  base::Status accept();
  // The oldest `edits` of those on trial, for good; the others stay on trial, each with its way
  // back, and so does what is being prepared on top of them. Not at a boundary.
  base::Status accept_oldest(size_t edits);
  // Trial -> Idle, or the trial of the edit before, with version 1 again; at a boundary, after
  // prime(). Inverse plan on the current state; values that the change dropped or narrowed come
  // back as they were, if nobody wrote them since; what somebody wrote is converted, and is refused
  // where that loses (kWouldLose).
  base::Result<SwitchReport> undo(Exits exits = Exits::kRun, Losses losses = Losses::kRefused);
  // In trial, of the edit that `below` others were made on top of: where its undo leads to.
  struct WayBack {
    const Plan& plan;
    const ir::VerifiedImage& from;
    const ir::VerifiedImage& to;
    int64_t predicted_pause_ns = 0;
    std::span<const uint32_t> leaving;  // as leaving()
  };
  WayBack way_back(size_t below) const;
  // Makes of a copy of the data of `from` what that undo makes of it, and tells the losses, the
  // first kMostLosses. FB_Exit does not run, and migrations only for the newest edit. After
  // prime(), beside the running program.
  struct ImaginedUndo {
    std::vector<LiveLoss> losses;
    uint64_t loss_count = 0;
  };
  ImaginedUndo imagine_undo(size_t below, uint8_t* memory);
  // In trial: the instances of the running version with an FB_Exit that undo() takes away.
  std::span<const uint32_t> leaving() const;
  // Before undo(), not at a boundary: what the version before needs to run is made again where
  // another edit has been prepared or undone since. Mostly there is nothing to do. An error changes
  // nothing: the trial goes on, and another call is another try.
  base::Status prime();
  // Any state before the switch -> Idle or Trial, as it was; frees what the change took, so not at
  // a boundary. Nothing in trial: that takes accept() or undo().
  void cancel();
  // Frees what the last change took. That takes time, so not at a boundary.
  void collect();

  // Asked before every single step from stage() to the publishing store; true abandons the change
  // there (kDeadline): a deadline that comes too near, or a test.
  void set_interruption(std::function<bool()> interrupted) {
    interrupted_ = std::move(interrupted);
  }
  // What measured_pace() (pace.h) says of this machine; 1 until then.
  void set_pace(double pace) { pace_ = pace; }
  // Told of the image that stage() has received, before it is verified: whoever takes it may store
  // it meanwhile, and shares its bytes. Nothing is known of them yet.
  using Received = std::function<void(std::shared_ptr<const base::Bytes> image)>;
  void set_received(Received received) { received_ = std::move(received); }

 private:
  struct Pending;

  // What memory running out in `step` makes of it: kNoMemory, and before the switch no change at
  // all.
  template <class Step>
  auto guarded(Step step) -> decltype(step());
  base::Status stage_steps(base::ByteSpan package, Strategy strategy, const AtBoundary& at_boundary,
                           TakenOut taken_out);
  void give_back(Plan& forward, const ir::Image& next, TakenOut taken_out) const;
  base::Status arm_steps(bool allow_loss, bool allow_overrun);
  base::Result<SwitchReport> switch_steps(bool again);
  base::Result<SwitchReport> undo_steps(Exits exits, Losses losses, bool whatever_happens = false);
  Pending& on_trial_at(size_t below) const;
  base::Status enter();
  void take_back();
  void put_back_kept();
  base::Status try_migrations(const AtBoundary& at_boundary);
  base::Status migrate();
  base::Status check_charts() const;
  // Describes the first `most`; returns how many there are.
  uint64_t find_losses(std::span<const uint8_t> memory, size_t most,
                       std::vector<LiveLoss>& rows) const;
  base::Status check_losses(bool allow_loss) const;
  base::Error not_in(const char* wanted) const;
  static base::Error no_boundary();
  static base::Error starts_anew();
  static base::Error not_primed();
  // False: interrupted, and abandoned.
  bool idle_units();
  bool unit();
  bool late_unit();  // not in idle time
  bool carry_in_place(const std::function<bool(const Loss&)>& on_loss);
  base::Status carry_over();
  std::string way_out() const;
  int64_t paced(int64_t model_ns) const;
  void abandon();
  base::Status adopt_steps(base::ByteSpan package, const ir::VerifiedImage& before,
                           const ir::VerifiedImage& after, base::ByteSpan retained);
  base::Status imagine_switch(Pending& edit, base::ByteSpan retained);
  void rest();
  void resume();
  base::Status leave(const std::vector<uint32_t>& ids);
  void count_switch();
  void count_undo();
  bool interrupted() const { return interrupted_ && interrupted_(); }
  base::Error abandoned(const char* where) const;
  SwitchReport report_begin() const;

  vm::Controller& controller_;
  State state_ = State::kIdle;
  std::unique_ptr<Pending> pending_;             // in trial: of the newest edit
  std::vector<std::unique_ptr<Pending>> below_;  // other edits on trial, oldest first
  // A generation that was published or prepared and is no longer used; it lives until the next
  // prepare(), because the controller's tables may still refer to it.
  std::unique_ptr<vm::Generation> retired_;
  vm::MovedForces moved_forces_;
  std::unique_ptr<Standby> retired_area_;
  std::unique_ptr<Pending> retired_pending_;  // freed by collect(), not at a boundary
  std::function<bool()> interrupted_;
  double pace_ = 1;
  Received received_;
};

}  // namespace online_change
