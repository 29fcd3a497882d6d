#include "vm/runtime/scheduler.h"

#include <algorithm>
#include <cstring>

#include "base/check.h"
#include "base/limits.h"

namespace vm {
namespace {

constexpr size_t kKeptTraps = 32;

}  // namespace

Scheduler::Scheduler(const ControllerOptions& options, Clock& clock, IoPort& io)
    : options_(options), clock_(clock), io_(io) {
  active_.reserve(base::kMaxTasks);
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
    outputs_stale_ = true;
  }
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
    task.begun_in_cycle = 0;
    task.status.stopped = false;
  }
  starting_ = true;
  while (TaskSlot* task = choose()) run_slice(*task);
  starting_ = false;
}

bool Scheduler::run_exits(int64_t limit_ns) {
  base::check(at_boundary(), "instances leave while a task is inside a scan");
  exit_limit_ns_ = limit_ns;
  exit_failed_ = false;
  leaving_ = true;
  looked_ns_ = clock_.now_ns();
  finish_start_tasks();
  leaving_ = false;
  return !exit_failed_;
}

void Scheduler::restart() {
  base::check(at_boundary(), "a restart while a task is inside a scan");
  auto next = [](int64_t at, int64_t step, int64_t from) {
    return at >= from ? at : at + (from - at + step - 1) / step * step;
  };
  next_cycle_ns_ = next(next_cycle_ns_, tables_->base_period_ns, clock_.now_ns());
  for (TaskSlot& task : tables_->tasks) {
    task.status.stopped = task.released = task.event_level = false;
    const int64_t period = task.status.period_ns;
    if (period != 0) task.next_release_ns = next(task.next_release_ns, period, next_cycle_ns_);
  }
  outputs_stale_ = true;
  faulted_ = start_pending_ = false;
}

void Scheduler::run_cycle() {
  if (faulted_) return;
  begin_cycle();
  if (start_pending_) finish_start_tasks();
  start_pending_ = false;
  while (TaskSlot* task = choose()) {
    run_slice(*task);
    if (looked_ns_ >= next_cycle_ns_) break;
  }
  ++cycles_;
}

void Scheduler::run_idle(const std::function<bool()>& unit) {
  base::check(at_boundary(), "idle work while a task is inside a scan");
  while (clock_.now_ns() + kIdleUnitNs <= next_cycle_ns_ && unit()) clock_.consumed(1);
}

void Scheduler::begin_cycle() {
  clock_.wait_until(next_cycle_ns_);
  looked_ns_ = clock_.now_ns();
  int64_t base = tables_->base_period_ns;
  // Cycles that nobody could start are gone, not made up for; releases in them count as missed.
  cycle_start_ns_ = next_cycle_ns_ + (looked_ns_ - next_cycle_ns_) / base * base;
  next_cycle_ns_ = cycle_start_ns_ + base;
  if (outputs_stale_) {
    impose(false);
    tables_->process_image.variables_to_outputs(memory_, tables_->outputs);
    outputs_stale_ = false;
  }
  io_.send(tables_->outputs);
  io_.receive(tables_->inputs);
  look_at_events();
  release_due_tasks();
}

// Forced, else as it came in just now, else as the programs left it.
bool Scheduler::event_level(const TaskSlot& task) const {
  for (const Force& force : tables_->forces) {
    if (force.symbol.data == task.event) return force.value[0] != 0;
  }
  if (task.event_mask != 0) return (tables_->inputs[task.event_byte] & task.event_mask) != 0;
  return memory_[task.event] != 0;
}

void Scheduler::look_at_events() {
  if (starting_) return;
  for (TaskSlot& task : tables_->tasks) {
    if (task.event == 0 || task.status.stopped) continue;
    bool level = event_level(task);
    if (level && !task.event_level) release(task);
    task.event_level = level;
  }
}

void Scheduler::release(TaskSlot& task) {
  bool still_running = std::find(active_.begin(), active_.end(), &task) != active_.end();
  if (task.released || still_running) {
    ++task.status.missed;
  } else {
    task.released = true;
  }
}

void Scheduler::release_due_tasks() {
  for (TaskSlot& task : tables_->tasks) {
    int64_t period = task.status.period_ns;
    if (task.status.stopped || period == 0 || task.next_release_ns > cycle_start_ns_) continue;
    if (task.event != 0 && task.event_level) {  // the period rests
      task.next_release_ns += period;
      continue;
    }
    int64_t passed_by = (cycle_start_ns_ - task.next_release_ns) / period;
    task.status.missed += static_cast<uint64_t>(passed_by);
    task.next_release_ns += (passed_by + 1) * period;
    release(task);
  }
}

TaskSlot* Scheduler::next_released() {
  for (uint32_t index : tables_->by_priority) {
    TaskSlot& task = tables_->tasks[index];
    if (starting_ && !task.once) continue;
    if (task.released && task.begun_in_cycle != cycles_ + 1) return &task;
  }
  return nullptr;
}

TaskSlot* Scheduler::choose() {
  TaskSlot* running = active_.empty() ? nullptr : active_.back();
  TaskSlot* released = next_released();
  if (released == nullptr) return running;
  if (running != nullptr && running->status.priority <= released->status.priority) return running;
  begin_task(*released);
  return active_.empty() ? choose() : active_.back();
}

void Scheduler::begin_task(TaskSlot& task) {
  task.released = false;
  task.begun_in_cycle = cycles_ + 1;
  if (task.programs.empty()) {
    ++task.status.scans;
    return;
  }
  task.stack = active_.empty() ? ir::kStackBegin : active_.back()->execution->stack_top();
  task.time_ns = cycle_start_ns_;
  task.run_ns = 0;
  task.fuel_used = 0;
  task.program = 0;
  std::copy(tables_->inputs.begin(), tables_->inputs.end(), task.inputs.begin());
  active_.push_back(&task);
  copy_inputs(task);
  impose(false);
  tables_->process_image.variables_to_outputs(memory_, task.outputs_at_start);
  begin_program(task);
}

void Scheduler::begin_program(TaskSlot& task) {
  task.execution->start(*tables_->generation, memory_, task.programs[task.program], task.stack,
                        task.time_ns);
}

uint64_t Scheduler::fuel_left(const TaskSlot& task) const {
  uint64_t used = task.fuel_used + task.execution->fuel_used();
  return options_.fuel_budget > used ? options_.fuel_budget - used : 0;
}

void Scheduler::run_slice(TaskSlot& task) {
  uint64_t slice = std::min(std::max<uint64_t>(options_.fuel_slice, 1), fuel_left(task));
  uint64_t used_before = task.execution->fuel_used();
  Exit exit = task.execution->run(slice);
  clock_.consumed(task.execution->fuel_used() - used_before);
  int64_t now = clock_.now_ns();
  task.run_ns += now - looked_ns_;
  looked_ns_ = now;

  const int64_t limit_ns = leaving_ ? exit_limit_ns_ : task.watchdog_ns;
  bool too_long = limit_ns > 0 && task.run_ns > limit_ns;
  if (exit == Exit::kTrap) {
    trap_in(task, task.execution->trap());
  } else if (too_long) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kWatchdog));
  } else if (exit == Exit::kDone) {
    end_program(task);
  } else if (fuel_left(task) == 0) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kFuel));
  }
}

void Scheduler::end_program(TaskSlot& task) {
  task.fuel_used += task.execution->fuel_used();
  if (++task.program < task.programs.size()) {
    begin_program(task);
  } else {
    end_task(task);
  }
}

void Scheduler::end_task(TaskSlot& task) {
  impose(false);
  copy_outputs(task);
  ++task.status.scans;
  task.status.last_ns = task.run_ns;
  task.status.max_ns = std::max(task.status.max_ns, task.run_ns);
  leave(task);
}

void Scheduler::leave(TaskSlot& task) {
  base::check(active_.back() == &task, "only the topmost activation can end");
  active_.pop_back();
  if (!active_.empty()) copy_inputs(*active_.back());
  look_at_events();
}

void Scheduler::trap_in(TaskSlot& task, const Trap& trap) {
  ++trap_count_;
  if (traps_.size() == kKeptTraps) traps_.erase(traps_.begin());
  traps_.push_back({cycles_, task.status.name, trap, describe(tables_->generation->image(), trap)});
  if (leaving_) {
    exit_failed_ = true;
    roll_back_outputs(task);
    leave(task);
    return;
  }
  task.status.stopped = true;
  if (options_.on_trap == TrapPolicy::kStopAll) {
    fault();
    return;
  }
  roll_back_outputs(task);
  leave(task);
}

void Scheduler::fault() {
  faulted_ = true;
  active_.clear();
  for (TaskSlot& task : tables_->tasks) task.released = false;
  std::fill(tables_->outputs.begin(), tables_->outputs.end(), uint8_t{0});
  io_.send(tables_->outputs);
}

// What the task wrote before it trapped never reaches the devices: its outputs stay as its last
// complete scan left them.
void Scheduler::roll_back_outputs(const TaskSlot& task) {
  const ProcessImage& image = tables_->process_image;
  base::Bytes& now = tables_->scratch;
  image.variables_to_outputs(memory_, now);
  for (size_t i = 0; i < now.size(); ++i) {
    auto written = static_cast<uint8_t>(now[i] ^ task.outputs_at_start[i]);
    now[i] = static_cast<uint8_t>((now[i] & ~written) | (tables_->outputs[i] & written));
  }
  image.outputs_to_variables(now, memory_);
}

void Scheduler::copy_inputs(const TaskSlot& task) {
  tables_->process_image.inputs_to_variables(task.inputs, memory_);
  impose(true);
}

// A suspended task may have written half of its outputs. Then only those go out that changed
// since this task began: they are its own, since each output has one writer (V14).
void Scheduler::copy_outputs(const TaskSlot& task) {
  const ProcessImage& image = tables_->process_image;
  if (active_.size() == 1) {
    image.variables_to_outputs(memory_, tables_->outputs);
    return;
  }
  base::Bytes& now = tables_->scratch;
  image.variables_to_outputs(memory_, now);
  for (size_t i = 0; i < now.size(); ++i) {
    auto written = static_cast<uint8_t>(now[i] ^ task.outputs_at_start[i]);
    tables_->outputs[i] =
        static_cast<uint8_t>((tables_->outputs[i] & ~written) | (now[i] & written));
  }
}

void Scheduler::impose(bool inputs_only) {
  for (const Force& force : tables_->forces) {
    if (inputs_only && !force.symbol.input) continue;
    std::memcpy(memory_ + force.symbol.data, force.value.data(), force.value.size());
  }
}

}  // namespace vm
