// What people see of the schedule (B11): states of tasks on the board, moments on the timeline.
#include <utility>

#include "vm/runtime/scheduler.h"

namespace vm {

void Scheduler::show(const TaskSlot& task) {
  const auto number = static_cast<size_t>(&task - tables_->tasks.data());
  board_.show(number, tables_->generation->number(),
              {task.state, task.late, task.inputs.state(), task.output_state()});
}

void Scheduler::become(TaskSlot& task, TaskState state) {
  task.state = state;
  show(task);
}

// The task has no scan now.
void Scheduler::rest(TaskSlot& task) {
  become(task, task.status.stopped || faulted_ ? TaskState::kStopped
               : task.released                 ? TaskState::kDue
               : task.late                     ? TaskState::kEndedLate
                                               : TaskState::kWaiting);
}

void Scheduler::rest_all() {
  for (TaskSlot& task : tables_->tasks) rest(task);
}

// Before it is the topmost activation; its inputs are chosen.
void Scheduler::note_begun(TaskSlot& task) {
  if (!active_.empty()) {
    become(*active_.back(), TaskState::kSuspended);
    note(Moment::kSuspended, *active_.back(), looked_ns_);
  }
  become(task, TaskState::kRunning);
  note(Moment::kBegun, task, looked_ns_);
  if (!tables_->inputs.empty()) note(Moment::kInputsOf, task, task.inputs.received_ns());
}

void Scheduler::resume(TaskSlot& task) {
  become(task, TaskState::kRunning);
  note(Moment::kResumed, task, looked_ns_);
}

void Scheduler::note(Moment moment, int64_t at_ns) const {
  if (options_.timeline != nullptr) options_.timeline->note(moment, {}, at_ns);
}

void Scheduler::note(Moment moment, const TaskSlot& task, int64_t at_ns) const {
  if (options_.timeline != nullptr) options_.timeline->note(moment, task.status.name, at_ns);
}

// Whatever was complete has gone out.
void Scheduler::note_sent() {
  note(Moment::kSent, looked_ns_);
  for (TaskSlot& task : tables_->tasks) {
    if (!std::exchange(task.unsent, false)) continue;
    show(task);
    note(Moment::kOutputsOf, task, looked_ns_);
  }
}

}  // namespace vm
