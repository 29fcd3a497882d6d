#include "vm/runtime/scheduler.h"

#include <algorithm>
#include <utility>

#include "base/check.h"
#include "base/limits.h"

namespace vm {
Scheduler::Scheduler(const ControllerOptions& options, Clock& clock, IoPort& io)
    : options_(options), clock_(clock), io_(io) {
  active_.reserve(base::kMaxTasks);
  traps_.reserve(kKeptTraps);
  without_text_ = std::make_shared<TrapRecord>(
      TrapRecord{0, {}, {}, {{}, {}, 0, "a trap; memory ran out for its text"}});
  next_cycle_ns_ = clock_.now_ns();
}

void Scheduler::use(TaskTables& tables, uint8_t* memory) {
  base::check(at_boundary(), "a program is replaced while a task is inside a scan");
  bool first = tables_ == nullptr;
  tables_ = &tables;
  memory_ = memory;
  if (first) {
    cycle_start_ns_ = next_cycle_ns_ - tables.base_period_ns;
  } else {
    next_cycle_ns_ = tables.next_cycle_ns(cycle_start_ns_);
  }
  outputs_stale_ = true;
  received_ahead_ = false;  // not all that this version reads
  receive_now_ = paused_;   // nor has the cycle that goes on
  for (TaskSlot& task : tables.tasks) task.scan_ns = clock_.scan_ns(task.status.name);
  rest_all();
}

// Events are looked at from the first cycle on.
void Scheduler::run_start_tasks() {
  const int64_t before = cycle_start_ns_;
  cycle_start_ns_ = looked_ns_ = next_cycle_ns_;
  finish_start_tasks();
  cycle_start_ns_ = before;
}

// Nothing else begins before they are done.
void Scheduler::finish_start_tasks() {
  for (TaskSlot& task : tables_->tasks) {
    if (!task.once) continue;
    task.released = true;
    task.released_ns = looked_ns_;
    task.begun_in_cycle = 0;
    task.status.stopped = false;
    rest(task);
  }
  starting_ = true;
  while (TaskSlot* task = choose()) run_slice(*task);
  starting_ = false;
}

bool Scheduler::try_start_tasks(int64_t limit_ns) {
  try_limit_ns_ = limit_ns;
  try_failed_ = false;
  trying_ = true;
  looked_ns_ = clock_.now_ns();
  finish_start_tasks();
  trying_ = false;
  return !try_failed_;
}

bool Scheduler::run_exits(int64_t limit_ns) {
  base::check(at_boundary(), "instances leave while a task is inside a scan");
  return try_start_tasks(limit_ns);
}

bool Scheduler::run_inits() {
  base::check(at_boundary(), "instances are made while a task is inside a scan");
  pack_stale_outputs();
  const int64_t before = std::exchange(cycle_start_ns_, next_cycle_ns_);
  const bool done = try_start_tasks(tables_->base_period_ns);
  cycle_start_ns_ = before;
  return done;
}

void Scheduler::restart() {
  base::check(at_boundary(), "a restart while a task is inside a scan");
  auto next = [](int64_t at, int64_t step, int64_t from) {
    return at >= from ? at : at + (from - at + step - 1) / step * step;
  };
  next_cycle_ns_ = next(next_cycle_ns_, tables_->base_period_ns, clock_.now_ns());
  for (TaskSlot& task : tables_->tasks) {
    task.status.stopped = task.released = task.event_level = false;
    task.due_again = task.overran = task.io_lost = task.late = task.held = false;
    task.inputs.restart();
    task.outputs.restart();
    const int64_t period = task.status.period_ns;
    if (period != 0) task.next_release_ns = next(task.next_release_ns, period, next_cycle_ns_);
  }
  std::fill(tables_->waiting_mask.begin(), tables_->waiting_mask.end(), uint8_t{0});
  tables_->safe.forget_holds();
  outputs_stale_ = true;
  faulted_ = start_pending_ = paused_ = lengthened_ = receive_now_ = false;
  received_ahead_ = send_pending_ = false;
  rest_all();
}

void Scheduler::run_cycle() {
  if (faulted_) return refresh_safe_outputs();
  if (!std::exchange(paused_, false)) begin_cycle();
  if (std::exchange(receive_now_, false)) {
    receive();
    receive_pending_ = false;
  }
  if (start_pending_) finish_start_tasks();
  start_pending_ = false;
  for (;;) {
    if (send_pending_ && !due_is_running()) exchange();
    TaskSlot* task = choose();
    if (task == nullptr) break;
    run_slice(*task);
    const bool again = std::exchange(again_, false);
    if (looked_ns_ >= next_cycle_ns_ && !lengthens_cycle()) break;
    if (again && at_boundary()) return pause();
  }
  if (send_pending_) exchange();
  end_cycle();
}

// B7, when the next cycle could begin: would a task be due in it whose scan is not done? Then
// inputs, outputs and all other releases wait until the scan is done.
bool Scheduler::lengthens_cycle() {
  const int64_t passed_by = (looked_ns_ - next_cycle_ns_) / tables_->base_period_ns;
  const int64_t begins_ns = next_cycle_ns_ + passed_by * tables_->base_period_ns;
  bool late = false;
  for (TaskSlot& task : tables_->tasks) {
    if (task.policy.overrun != ir::Overrun::kLengthen) continue;
    if (!task.released && !is_active(task)) continue;
    // A slice can last over the begin of several cycles: if it is due in any of them, all move.
    lengthened_ = lengthened_ || task.next_release_ns <= begins_ns;
    if (task.next_release_ns > next_cycle_ns_) continue;
    late = true;
    if (std::exchange(task.due_again, true)) continue;
    note_overrun(task);
  }
  return late;
}

// The pause counts as a cycle: what is seen at this boundary is not what is seen at the end.
void Scheduler::pause() {
  paused_ = true;
  ++cycles_;
}

// A cycle that was lengthened moves all that come after it: nobody has missed a release.
void Scheduler::end_cycle() {
  ++cycles_;
  if (!std::exchange(lengthened_, false) || looked_ns_ <= next_cycle_ns_) return;
  const int64_t longer_ns = looked_ns_ - next_cycle_ns_;
  cycle_start_ns_ += longer_ns;
  next_cycle_ns_ += longer_ns;
  // Moves all tasks: where cycles begin is measured by any of them.
  for (TaskSlot& task : tables_->tasks) task.next_release_ns += longer_ns;
}

void Scheduler::run_idle(const std::function<bool()>& unit) {
  base::check(at_boundary(), "idle work while a task is inside a scan");
  while (clock_.now_ns() + kIdleUnitNs <= next_cycle_ns() && unit()) clock_.consumed(1);
}

void Scheduler::begin_cycle() {
  clock_.wait_until(next_cycle_ns_);
  looked_ns_ = clock_.now_ns();
  int64_t base = tables_->base_period_ns;
  // Cycles that nobody could start are gone, not made up for; releases in them count as missed.
  cycle_start_ns_ = next_cycle_ns_ + (looked_ns_ - next_cycle_ns_) / base * base;
  next_cycle_ns_ = cycle_start_ns_ + base;
  note(Moment::kCycle, cycle_start_ns_);
  pack_stale_outputs();
  take_waiting_outputs();
  // The first cycle after a start or a change has no inputs of the cycle before.
  send_pending_ = tables_->schedule == ir::Schedule::kRunFirst;
  receive_pending_ = send_pending_ && std::exchange(received_ahead_, false);
  if (!receive_pending_) {
    send();
    receive();
  }
  if (at_boundary()) io_.take_globals(tables_->shared, memory_);
  look_at_events();
  release_due_tasks();
}

void Scheduler::send() {
  take_sendable_outputs();
  end_holds(cycle_start_ns_);
  impose_on_outputs();
  transmit();
  note_sent();
}

void Scheduler::receive() {
  base::Bytes& newest = tables_->newest_inputs;
  io_.receive(newest.empty() ? tables_->inputs : newest);
  std::copy(newest.begin(), newest.end(), tables_->inputs.begin());
  received_ns_ = looked_ns_;
  note(Moment::kReceived, received_ns_);
  look_at_losses();
  offer_inputs();
}

// B2, when tasks run first. At most one receive() in each call of run_cycle().
void Scheduler::exchange() {
  send();
  if (receive_pending_) receive();
  send_pending_ = receive_pending_ = false;
  received_ahead_ = true;
}

// What goes on from a cycle before is not waited for, nor what is released whenever it is idle.
bool Scheduler::due_is_running() const {
  for (const TaskSlot& task : tables_->tasks) {
    if (task.policy.freewheeling) continue;
    const bool begun = task.begun_in_cycle == cycles_ + 1;
    if (begun ? is_active(task) : task.released) return true;
  }
  return false;
}

void Scheduler::pack_stale_outputs() {
  if (!outputs_stale_) return;
  impose(false);
  pack_outputs();
  outputs_stale_ = false;
}

// Forced, else as it came in just now, else as the programs left it.
bool Scheduler::event_level(const TaskSlot& task) const {
  for (const Force& force : tables_->forced.forces) {
    if (force.symbol.data == task.event) return force.value[0] != 0;
  }
  if (task.event_mask != 0) {
    const uint8_t received = tables_->inputs[task.event_byte];
    return (tables_->input(task.event_byte, received) & task.event_mask) != 0;
  }
  return memory_[task.event] != 0;
}

void Scheduler::look_at_events() {
  if (starting_) return;
  for (TaskSlot& task : tables_->tasks) {
    if (task.event == 0 || task.status.stopped) continue;
    bool level = event_level(task);
    if (level && !task.event_level) release(task, looked_ns_);
    task.event_level = level;
  }
}

// Once for each loss: the flag stays until a scan begins.
void Scheduler::look_at_losses() {
  std::fill(tables_->lost.begin(), tables_->lost.end(), uint8_t{0});
  io_.lost_tasks(tables_->lost);
  for (size_t i = 0; i < tables_->lost.size(); ++i) {
    if (tables_->lost[i] != 0) tables_->tasks[i].io_lost = true;
  }
}

bool Scheduler::is_active(const TaskSlot& task) const {
  return std::find(active_.begin(), active_.end(), &task) != active_.end();
}

// B7. `due_ns` is when it was due. True: a scan will begin with this release.
bool Scheduler::release(TaskSlot& task, int64_t due_ns) {
  if (!task.released && !is_active(task)) {
    task.released = true;
    task.released_ns = due_ns;
    if (task.state != TaskState::kRunning) rest(task);
    note(Moment::kReleased, task, due_ns);
    return true;
  }
  note_overrun(task);
  const bool comes_later = task.policy.overrun == ir::Overrun::kAtOnce ||
                           task.policy.overrun == ir::Overrun::kStretch;
  note(comes_later && !task.due_again ? Moment::kReleased : Moment::kMissed, task, due_ns);
  switch (task.policy.overrun) {
    case ir::Overrun::kSkip:
    case ir::Overrun::kLengthen:  // a cycle has passed since the clock was looked at last
      ++task.status.missed;
      break;
    case ir::Overrun::kStretch:
      task.due_again = true;
      break;
    case ir::Overrun::kAtOnce:  // one start for all releases that the scan is late for
      if (task.due_again) ++task.status.missed;
      if (!std::exchange(task.due_again, true)) task.due_again_ns = due_ns;
      break;
    case ir::Overrun::kFault:
      task.overran = true;
      break;
  }
  return false;
}

void Scheduler::release_due_tasks() {
  for (TaskSlot& task : tables_->tasks) {
    if (!task.status.stopped) release_due_task(task);
  }
}

void Scheduler::release_due_task(TaskSlot& task) {
  const bool idle = !task.released && !is_active(task);
  if (task.policy.freewheeling && idle) release(task, cycle_start_ns_);
  const int64_t period = task.status.period_ns;
  if (period == 0 || task.next_release_ns > cycle_start_ns_) return;
  if (task.event != 0 && task.event_level) {  // the period rests
    task.next_release_ns += period;
    return;
  }
  const int64_t passed_by = (cycle_start_ns_ - task.next_release_ns) / period;
  task.status.missed += static_cast<uint64_t>(passed_by);
  // The delay counts from the first release that nobody could begin, so it can exceed a period.
  const int64_t due_ns = std::exchange(task.next_release_ns,
                                       task.next_release_ns + (passed_by + 1) * period);
  const bool begins = release(task, due_ns);
  if (begins && task.synchronous()) task.inputs.write(tables_->inputs, received_ns_);
}

// To all that take the newest. Where that is the same, it is done when the scan begins (B2, B4).
void Scheduler::offer_inputs() {
  for (TaskSlot& task : tables_->tasks) {
    const bool each_cycle = !task.synchronous() && !task.inputs.reads_last_written();
    if (!each_cycle || task.exchanges()) continue;
    task.inputs.write(tables_->inputs, received_ns_);
    show(task);
  }
}

// What waits, and what has no variable, stays what was sent last.
void Scheduler::pack_outputs() {
  tables_->process_image.variables_to_outputs(memory_, tables_->scratch);
  take_packed();
}

void Scheduler::take_packed() {
  const base::Bytes& now = tables_->scratch;
  for (size_t i = 0; i < now.size(); ++i) {
    const auto keep = static_cast<uint8_t>(tables_->waiting_mask[i] | tables_->unused[i]);
    tables_->outputs[i] = static_cast<uint8_t>((tables_->outputs[i] & keep) | (now[i] & ~keep));
  }
}


}  // namespace vm
