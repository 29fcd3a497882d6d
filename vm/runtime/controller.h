// The soft PLC: tasks, process image, forces and watches over one Machine. One control thread
// owns a Controller; other threads talk to it through mailbox.h only.
//
// A control cycle (base period = greatest common divisor of all task periods):
// outputs sent, inputs received, due tasks run by priority with safe-point
// suspension of lower ones, then service at the boundary (D6): commands, watches,
// and whatever online change has armed. With ir::Schedule::kRunFirst the tasks run before the
// exchange. A boundary is an instant at which no execution exists; a long low-priority task
// postpones it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/symbols.h"
#include "ir/bytecode/verify.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"
#include "vm/exec/tier.h"
#include "vm/load/generation.h"
#include "vm/runtime/forces.h"
#include "vm/runtime/ports.h"
#include "vm/runtime/task_activity.h"
#include "vm/runtime/timeline.h"
#include "vm/runtime/write_set.h"

namespace vm {

class BoundaryWatch;  // boundary_watch.h
class EventRing;      // event_ring.h

// Which variables a restart leaves as they are: none, those that are RETAIN, all.
enum class Restart : uint8_t { kCold, kWarm, kHot };

// What a unit of idle work takes at most; where less is left before a cycle, none is begun.
inline constexpr int64_t kIdleUnitNs = 20'000;

struct ControllerOptions {
  ir::OnTrap on_trap = ir::OnTrap::kStopAll;  // of tasks that do not state it; not kUnstated
  uint64_t fuel_slice = 1000;         // safe points between two looks at the clock; hard mode: 1
  uint64_t fuel_budget = 50'000'000;  // safe points of one scan of one task before kFuel
  uint64_t code_limit = uint64_t{2} << 30;  // bytes of all code slots (two for each POU)
  uint64_t code_slack_percent = CodeSlots::kSlackPercent;  // of each slot, when it is made (D5)
  TierOptions tier = {};
  bool halted = false;           // begins as after a fault: nothing runs before restart()
  uint64_t data_limit = 0;       // bytes of all data areas of a change together; 0: no limit
  Timeline* timeline = nullptr;  // is told of all cycles; outlives the controller
  EventRing* events = nullptr;   // gets traps and overruns; outlives the controller
};

// Times of all scans of a task so far, in ns; p99: 99 % took no longer (histogram.h).
struct TimeSummary {
  int64_t min = 0;
  int64_t average = 0;
  int64_t p99 = 0;
  int64_t max = 0;
  int64_t total = 0;
};
// One class of a histogram: so many took less than `end_ns`, and not less than the class before.
struct TimeClass {
  int64_t end_ns = 0;
  uint64_t count = 0;
};
struct TaskTimes {
  std::string name;
  std::vector<TimeClass> run;  // classes with something in them
  std::vector<TimeClass> delay;
};

struct TaskStatus {
  std::string name;
  int64_t period_ns = 0;
  uint32_t priority = 0;
  uint64_t scans = 0;     // completed
  uint64_t overruns = 0;  // releases that found the scan before not done
  uint64_t missed = 0;    // releases without a scan
  int64_t last_ns = 0;    // run time of the last scan
  TimeSummary run;        // of its own run time, without that of tasks above it
  TimeSummary delay;      // from the release to the start: jitter
  bool stopped = false;   // by a trap
  bool freewheeling = false;
  bool once = false;           // start code: at cold start and after changes
  int64_t recent_ns = 0;       // the longest run of the last scans (recent_longest.h)
  TaskActivity activity = {};  // at another instant than the rest (Controller::activity)
};

struct TrapRecord {
  uint64_t cycle = 0;
  std::string task;
  Trap trap;
  TrapText text;
};

struct TaskSample;  // live_copy.h
inline constexpr size_t kKeptTraps = 32;
using Traps = std::vector<std::shared_ptr<const TrapRecord>>;

class Controller {
 public:
  // Cold start: all variables hold their initial values, and the tasks that run once have run.
  // With `retained`, the bytes of the ranges of Image::retain, as at a warm start: those are in
  // place before. `clock` and `io` must outlive it.
  static base::Result<std::unique_ptr<Controller>> start(const ir::VerifiedImage& image,
                                                         ControllerOptions options, Clock& clock,
                                                         IoPort& io, base::ByteSpan retained = {});
  ~Controller();

  // Runs one control cycle, waiting for its start first; nothing when faulted. It returns before
  // the cycle is over where a task that was late starts `at_once` and a boundary can come first;
  // the next call goes on, without waiting. Both count as cycles.
  void cycle();
  // At a boundary, in the idle time before the next cycle (B10, C5): calls `unit` until it says
  // that it had nothing to do, or another one might not be over when the cycle begins. A unit takes
  // kIdleUnitNs at most, and counts as one safe point for a virtual clock.
  void run_idle(const std::function<bool()>& unit);
  // At a boundary, after work there that no scan did: Clock::worked.
  void worked(int64_t expected_ns);
  // At a boundary: from now on `watch` is called at each; null: nobody.
  void watch(BoundaryWatch* watch);
  uint64_t cycles() const;
  bool at_boundary() const;
  bool faulted() const;
  // Start code has yet to run, with the next cycle: behind construct(), or a restart.
  bool start_pending() const;
  bool starts_anew() const;  // behind a restart
  // Next instant at which a task is released.
  int64_t next_release_ns() const;
  // Start of the next control cycle, with or without a release: idle time ends here. An instant
  // that has passed when cycle() has returned before the cycle was over.
  int64_t next_cycle_ns() const;
  int64_t base_period_ns() const;

  const ir::Image& image() const;
  const ir::VerifiedImage& verified() const;
  const Generation& generation() const;
  // The code table that scans begin with: another one than the generation's own while something is
  // forced. At a boundary.
  const CodeTable& code() const;
  // Making::kBeside: machine code of so many POUs is still to be made by a thread in the
  // background; until then all are interpreted. Any thread.
  uint32_t pous_to_make() const;
  Memory& memory();
  uint64_t data_limit() const;
  std::vector<TaskStatus> tasks() const;
  // Any thread, at any time: what the task of that number does now. nullopt: a version of another
  // number runs (Generation::number).
  std::optional<TaskActivity> activity(size_t task, uint32_t generation) const;
  // Histograms of a task; nullopt: there is none of this name.
  std::optional<TaskTimes> task_times(std::string_view name) const;
  // At a boundary: forgets how long scans took and how late they began; counters go on.
  void reset_times();
  uint64_t missed_releases() const;  // of all tasks
  // At a boundary: what the last scans of all cyclic tasks take of their periods, in thousandths.
  uint64_t load() const;
  // At a boundary; nothing is allocated where `out` has the task's name already.
  void copy_task(size_t number, TaskSample& out) const;
  const Traps& traps() const;   // the last 32
  uint64_t trap_count() const;  // all that there were

  // Values, at a boundary. Paths as in symbols.h.
  base::Result<std::string> get(std::string_view path) const;
  base::Status set(std::string_view path, std::string_view value);
  // To be prepared off the control thread, at any time; all or none. kTooMany: more than one
  // boundary has room for.
  base::Result<WriteSet> prepare_set(std::span<const NamedValue> values) const;
  // At a boundary. False, and nothing is written: another version runs than it was prepared for.
  bool write(const WriteSet& set);
  // A force is imposed when inputs are copied in and before outputs are copied out, and on other
  // variables before and after every scan. Code that writes the variable is exchanged for versions
  // that do not (forced_code.h), or the force says why that cannot be.
  // To be prepared off the control thread, at any time; all or none, and nothing changes yet.
  base::Result<std::unique_ptr<ForceChange>> prepare_force(
      std::span<const NamedValue> values) const;
  base::Result<std::unique_ptr<ForceChange>> prepare_unforce(
      std::span<const std::string> paths) const;
  // Likewise: the code of forces that was made while machine code was still being made, so that all
  // is interpreted, with that. Null: there is nothing to make anew.
  std::unique_ptr<ForceChange> renew_forces() const;
  // At a boundary: what was prepared for the version that runs comes into force. `change` has what
  // was before, which takes time to free.
  void use(ForceChange& change);
  // Both at once, at a boundary.
  base::Status force(std::string_view path, std::string_view value);
  base::Status unforce(std::string_view path);
  const std::vector<Force>& forces() const;
  // What becomes of the forces with this generation, which was prepared.
  const ForcedSet& next_forces(const Generation& prepared) const;

  // --- for online change (online_change/apply) --------------------------------
  // Builds a second generation beside the running one. Touches nothing that runs; whatever was
  // prepared or published before can run no more. kTooLarge when its code has no room. `back`:
  // forces on variables of this image that begin with it again.
  base::Result<std::unique_ptr<Generation>> prepare(ir::VerifiedImage image, ForceList back = {});
  const CodeSlots& code_slots() const;
  // At a boundary only: one pointer store makes `next` the running generation, and
  // re-derives task, I/O and force tables that were prepared by prepare(). Tasks keep scan
  // counts and phase by name. Returns the generation that ran until now.
  // With `data`, that is exchanged with the running data area by the same store (C6).
  std::unique_ptr<Generation> publish(std::unique_ptr<Generation> next, Memory* data = nullptr);
  // Once, after publish(): what it did to forces.
  MovedForces take_moved_forces();
  // Off the control thread: devices that only a version which never runs again has are closed.
  void settle_devices();
  // Off the control thread, after a switch that did not wait for machine code (Making::kBeside):
  // begins to make that of the version that runs now.
  void make_native();
  std::vector<DeviceStatus> devices() const;
  // After a change that is not made: the next cycle begins with the start code, which makes what
  // has left anew.
  void construct();
  // At a boundary, after publish(): runs the start code, which makes what is new, at the time of
  // the next cycle. kInitFailed when it traps or takes longer than a base period: the published
  // version must not run then. After a fault nothing is done.
  base::Status enter();
  // At a boundary: FB_Exit of these instances, those around others first. When one traps or takes
  // longer than `limit_ns`, the rest is left out and the old program can run on after construct().
  base::Status leave(const std::vector<uint32_t>& ids, int64_t limit_ns);
  // After a leave() whose values were put back: outputs are as before, too.
  void values_put_back();
  // Lets all instances leave, and their outputs are sent: nothing runs after it.
  base::Status leave_all(int64_t limit_ns);

  // The last thing before a controller ends, also in the middle of a scan. What would be held for
  // a time takes its value: nobody is there when it is over.
  void make_outputs_safe();

  // At a boundary, also after a fault: all tasks run again. Cold and warm: instances leave first,
  // unless a fault ended everything, and start code makes them anew in the next cycle. Forces stay.
  // Returns the error of leave_all(), after which the restart is made all the same.
  base::Status restart(Restart kind, int64_t exit_limit_ns);

 private:
  Controller();
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vm
