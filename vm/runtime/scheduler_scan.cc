// The scans of tasks: begun, run in slices, ended, trapped; and what becomes of their outputs.
#include <algorithm>
#include <cstring>
#include <utility>

#include "base/check.h"
#include "vm/exec/store_aside.h"
#include "vm/runtime/byte_masks.h"
#include "vm/runtime/scheduler.h"

namespace vm {

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
  const bool goes_on = running != nullptr &&
                       (released == nullptr ||
                        running->status.priority <= released->status.priority);
  if (goes_on && running->state == TaskState::kSuspended) resume(*running);
  if (goes_on || released == nullptr) return running;
  begin_task(*released);
  return active_.empty() ? choose() : active_.back();
}

void Scheduler::begin_task(TaskSlot& task) {
  task.released = false;
  task.begun_in_cycle = cycles_ + 1;
  if (task.programs.empty()) {
    ++task.status.scans;
    return rest(task);
  }
  task.stack = active_.empty() ? ir::kStackBegin : active_.back()->execution->stack_top();
  task.time_ns = cycle_start_ns_;
  task.times->delay.add(looked_ns_ - task.released_ns);
  task.run_ns = 0;
  task.fuel_used = 0;
  task.program = 0;
  task.late = task.lasting = false;
  if (task.exchanges()) {
    receive_for(task);
  } else if (!task.synchronous() && task.inputs.wants_last()) {
    task.inputs.write(tables_->inputs, received_ns_);
  }
  task.inputs.begin();
  if (task.outputs.takes_before_scan() && !task.synchronous()) take_outputs(task);
  note_begun(task);
  active_.push_back(&task);
  copy_inputs(task);
  impose(false);
  tables_->process_image.variables_to_outputs(memory_, task.outputs_at_start);
  begin_program(task);
  if (std::exchange(task.io_lost, false)) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kIoLost));
  }
}

void Scheduler::begin_program(TaskSlot& task) {
  task.execution->start(*tables_->generation, *tables_->code, memory_, task.programs[task.program],
                        task.stack, task.time_ns);
}

uint64_t Scheduler::fuel_left(const TaskSlot& task) const {
  uint64_t used = task.fuel_used + task.execution->fuel_used();
  return options_.fuel_budget > used ? options_.fuel_budget - used : 0;
}

void Scheduler::run_slice(TaskSlot& task) {
  if (std::exchange(task.overran, false)) {
    return trap_in(task, task.execution->interrupted(ir::TrapKind::kOverrun));
  }
  if (task.lasting) return let_last(task);
  uint64_t slice = std::min(std::max<uint64_t>(options_.fuel_slice, 1), fuel_left(task));
  uint64_t used_before = task.execution->fuel_used();
  Exit exit = task.execution->run(slice);
  clock_.consumed(task.execution->fuel_used() - used_before);
  int64_t now = clock_.now_ns();
  task.run_ns += now - looked_ns_;
  looked_ns_ = now;

  if (exit == Exit::kTrap) {
    trap_in(task, task.execution->trap());
  } else if (is_too_long(task)) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kWatchdog));
  } else if (exit == Exit::kDone) {
    end_program(task);
  } else if (fuel_left(task) == 0) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kFuel));
  }
}

bool Scheduler::is_too_long(const TaskSlot& task) const {
  const int64_t limit_ns = trying_ ? try_limit_ns_ : task.watchdog_ns;
  return limit_ns > 0 && task.run_ns > limit_ns;
}

// B11: its code is done; time passes until it has lasted long enough, its watchdog ends it or
// something else can be due.
void Scheduler::let_last(TaskSlot& task) {
  int64_t step = task.scan_ns - task.run_ns;
  if (task.watchdog_ns > 0) step = std::min(step, task.watchdog_ns + 1 - task.run_ns);
  if (looked_ns_ < next_cycle_ns_) step = std::min(step, next_cycle_ns_ - looked_ns_);
  clock_.worked(step);
  looked_ns_ += step;
  task.run_ns += step;
  if (is_too_long(task)) {
    trap_in(task, task.execution->interrupted(ir::TrapKind::kWatchdog));
  } else if (task.run_ns >= task.scan_ns) {
    end_task(task);
  }
}

void Scheduler::end_program(TaskSlot& task) {
  task.fuel_used += task.execution->fuel_used();
  if (++task.program < task.programs.size()) {
    begin_program(task);
  } else if (task.run_ns < task.scan_ns && !trying_) {
    task.lasting = true;
  } else {
    end_task(task);
  }
}

void Scheduler::end_task(TaskSlot& task) {
  impose(false);
  if (active_.size() == 1 && tables_->plain_outputs) {
    tables_->process_image.variables_to_outputs(memory_, tables_->outputs);
    add_differences(task.own_outputs, tables_->outputs, task.outputs_at_start);
  } else {
    find_written(task);
    if (tables_->process_image.has_nan(tables_->scratch, tables_->written)) {
      return trap_in(task, task.execution->interrupted(ir::TrapKind::kNotANumber));
    }
    copy_outputs(task);
  }
  (task.outputs.used() ? task.held : task.unsent) = !tables_->outputs.empty();
  note(Moment::kEnded, task, looked_ns_);
  if (task.exchanges()) send_of(task);
  ++task.status.scans;
  task.status.last_ns = task.run_ns;
  task.times->run.add(task.run_ns);
  task.times->recent_run.add(task.run_ns);
  leave(task);
}

void Scheduler::leave(TaskSlot& task) {
  base::check(active_.back() == &task, "only the topmost activation can end");
  active_.pop_back();
  task.inputs.end();
  if (std::exchange(task.due_again, false) && !task.status.stopped) start_again(task);
  rest(task);
  if (!active_.empty()) copy_inputs(*active_.back());
  look_at_events();
}

// B7: its scan has ended, and it was due before.
void Scheduler::start_again(TaskSlot& task) {
  if (task.policy.overrun == ir::Overrun::kAtOnce) {
    task.released = again_ = true;
    task.released_ns = task.due_again_ns;
    task.begun_in_cycle = 0;  // a second time in this cycle, perhaps
  } else if (task.policy.overrun == ir::Overrun::kStretch) {
    if (task.status.period_ns == 0) {
      release(task, looked_ns_);
    } else {
      task.next_release_ns = next_cycle_ns_;
    }
  }
}

void Scheduler::trap_in(TaskSlot& task, const Trap& trap) {
  note_trap(task, trap);
  note(Moment::kTrapped, task, looked_ns_);
  if (trying_) {
    try_failed_ = true;
    roll_back_outputs(task);
    leave(task);
    return;
  }
  const ir::OnTrap stated = task.policy.on_trap;
  switch (stated == ir::OnTrap::kUnstated ? options_.on_trap : stated) {
    case ir::OnTrap::kGoOn:
      roll_back_outputs(task);
      break;
    case ir::OnTrap::kStopTask:
      task.status.stopped = true;
      stop_outputs(task);
      break;
    default:
      task.status.stopped = true;
      return fault();
  }
  leave(task);
}

// Half of what was written is nowhere any more, so a hot restart cannot send it.
void Scheduler::fault() {
  faulted_ = true;
  active_.clear();
  for (TaskSlot& task : tables_->tasks) task.released = false;
  send_pending_ = false;
  make_outputs_safe(false);
  outputs_to_variables(tables_->written);
  rest_all();
}

void Scheduler::make_outputs_safe(bool for_good) {
  base::Bytes& all = tables_->written;
  std::fill(all.begin(), all.end(), uint8_t{0xff});
  tables_->safe.apply(all, looked_ns_, tables_->outputs);
  if (for_good) tables_->safe.expire(INT64_MAX, tables_->outputs, all);
  transmit();
  note(Moment::kSent, looked_ns_);
}

void Scheduler::refresh_safe_outputs() {
  const int64_t now = clock_.now_ns();
  if (end_holds(now)) transmit();
}

bool Scheduler::end_holds(int64_t now_ns) {
  if (tables_->safe.next_ns() > now_ns) return false;
  base::Bytes& mask = tables_->written;
  std::fill(mask.begin(), mask.end(), uint8_t{0});
  tables_->safe.expire(now_ns, tables_->outputs, mask);
  outputs_to_variables(mask);
  return true;
}

// Variables of the outputs in `mask` become what is sent.
void Scheduler::outputs_to_variables(std::span<const uint8_t> mask) {
  base::Bytes& now = tables_->scratch;
  tables_->process_image.variables_to_outputs(memory_, now);
  for (size_t i = 0; i < now.size(); ++i) {
    now[i] = static_cast<uint8_t>((now[i] & ~mask[i]) | (tables_->outputs[i] & mask[i]));
  }
  tables_->process_image.outputs_to_variables(now, memory_);
  hand_down(mask);
}

// The bits of `mask` in `scratch` are not of the scans below.
void Scheduler::hand_down(std::span<const uint8_t> mask) {
  const base::Bytes& now = tables_->scratch;
  for (TaskSlot* below : active_) merge(below->outputs_at_start, now, mask);
}

// Outputs as they are in the variables now, to `scratch`, and those among them that differ from
// when the scan began, to `written`: they are its own, since each output has one writer (V14).
void Scheduler::find_written(const TaskSlot& task) {
  base::Bytes& now = tables_->scratch;
  tables_->process_image.variables_to_outputs(memory_, now);
  std::fill(tables_->written.begin(), tables_->written.end(), uint8_t{0});
  add_differences(tables_->written, now, task.outputs_at_start);
}

// What the task wrote before it trapped never reaches the devices: its outputs are what they were
// when its scan began.
void Scheduler::roll_back_outputs(const TaskSlot& task) {
  find_written(task);
  base::Bytes& now = tables_->scratch;
  for (size_t i = 0; i < now.size(); ++i) {
    const uint8_t written = tables_->written[i];
    now[i] = static_cast<uint8_t>((now[i] & ~written) | (task.outputs_at_start[i] & written));
  }
  tables_->process_image.outputs_to_variables(now, memory_);
}

// In this cycle still, and in the variables too. What is forced stays so.
void Scheduler::stop_outputs(TaskSlot& task) {
  find_written(task);
  base::Bytes& mask = tables_->written;
  for (size_t i = 0; i < mask.size(); ++i) {
    mask[i] |= task.own_outputs[i];
  }
  tables_->process_image.widen(mask);
  for (size_t i = 0; i < mask.size(); ++i) {
    tables_->waiting_mask[i] &= static_cast<uint8_t>(~mask[i]);
  }
  task.outputs.restart();
  tables_->safe.apply(mask, looked_ns_, tables_->outputs);
  impose_on_outputs();
  outputs_to_variables(mask);
  transmit();
  task.held = false;
  note_sent();
}

void Scheduler::copy_inputs(const TaskSlot& task) {
  const std::span<const uint8_t> inputs = task.inputs.inputs();
  if (tables_->forced.input_mask.empty()) {
    return tables_->process_image.inputs_to_variables(inputs, memory_);
  }
  base::Bytes& seen = tables_->seen_inputs;
  for (size_t i = 0; i < seen.size(); ++i) seen[i] = tables_->input(i, inputs[i]);
  tables_->process_image.inputs_to_variables(seen, memory_);
  impose(true);
}

// Complete results only (B5): a task below may have written half of its outputs.
void Scheduler::copy_outputs(TaskSlot& task) {
  const base::Bytes& now = tables_->scratch;
  const base::Bytes& written = tables_->written;
  merge(task.own_outputs, written, written);
  if (task.outputs.used()) {
    task.outputs.write(now, written);
    merge(tables_->waiting_mask, written, written);
  } else {
    merge(tables_->outputs, now, written);
  }
  hand_down(written);
  if (active_.size() == 1) take_packed();  // also what no task has written
}

void Scheduler::impose(bool inputs_only) {
  for (const Force& force : tables_->forced.forces) {
    if (inputs_only && !force.symbol.input) continue;
    put_value(memory_ + force.symbol.data, force.value.data(), force.value.size(),
              force.symbol.bit_mask);
  }
}

// Forced outputs do not wait for anything. False: none is forced.
bool Scheduler::impose_on_outputs() {
  bool any = false;
  base::Bytes& mask = tables_->forced_outputs;
  for (const Force& force : tables_->forced.forces) {
    if (!force.symbol.output) continue;
    if (!any) std::fill(mask.begin(), mask.end(), uint8_t{0});
    any = true;
    const auto size = static_cast<uint32_t>(force.value.size());
    put_value(memory_ + force.symbol.data, force.value.data(), size, force.symbol.bit_mask);
    tables_->process_image.mark_outputs(force.symbol.data, force.symbol.data + size, mask);
  }
  if (!any) return false;
  base::Bytes& now = tables_->scratch;
  tables_->process_image.variables_to_outputs(memory_, now);
  for (size_t i = 0; i < now.size(); ++i) {
    tables_->outputs[i] =
        static_cast<uint8_t>((tables_->outputs[i] & ~mask[i]) | (now[i] & mask[i]));
  }
  return true;
}

// Who looks at this boundary finds what was said to hold, whether a cycle has come or not.
void Scheduler::impose_at_boundary() {
  if (faulted_) return;
  impose(false);
  const auto is_output = [](const Force& force) { return force.symbol.output; };
  outputs_stale_ |= std::ranges::any_of(tables_->forced.forces, is_output);
}

void Scheduler::forces_exchanged(const ForcedSet& before) {
  if (faulted_) return;
  impose_at_boundary();
  base::Bytes& forced = tables_->forced_outputs;
  base::Bytes& mask = tables_->written;
  std::fill(forced.begin(), forced.end(), uint8_t{0});
  std::fill(mask.begin(), mask.end(), uint8_t{0});
  for (const Force& force : before.forces) {
    if (!force.symbol.output) continue;
    const auto size = static_cast<uint32_t>(force.value.size());
    tables_->process_image.mark_outputs(force.symbol.data, force.symbol.data + size, forced);
  }
  for (const TaskSlot& task : tables_->tasks) {
    if (!task.status.stopped) continue;
    for (size_t i = 0; i < mask.size(); ++i) mask[i] |= task.own_outputs[i] & forced[i];
  }
  if (std::all_of(mask.begin(), mask.end(), [](uint8_t bits) { return bits == 0; })) return;
  tables_->safe.apply(mask, clock_.now_ns(), tables_->outputs);
  impose_on_outputs();
  outputs_to_variables(mask);
  outputs_stale_ = true;
}

void Scheduler::outputs_set(std::span<const WriteSet::OutputBits> outputs) {
  for (const auto& row : outputs) {
    for (TaskSlot& task : tables_->tasks) task.outputs.forget(row.byte, row.mask);
    tables_->waiting_mask[row.byte] &= static_cast<uint8_t>(~row.mask);
  }
  outputs_stale_ |= !outputs.empty();
  impose_at_boundary();
}

}  // namespace vm
