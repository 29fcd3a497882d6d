// Transmissions and receptions beside those that a cycle begins or ends with: what tasks have in
// buffers of their own (B5, B6), and what they exchange by themselves (B12).
#include <algorithm>
#include <utility>

#include "vm/runtime/byte_masks.h"
#include "vm/runtime/scheduler.h"

namespace vm {

// The task's buffer gives what is next to what is sent next.
void Scheduler::take_outputs(TaskSlot& task) {
  if (!std::exchange(task.held, false)) return;
  base::Bytes& taken = tables_->written;
  task.outputs.take(tables_->outputs, taken);
  for (size_t i = 0; i < taken.size(); ++i) {
    tables_->waiting_mask[i] &= static_cast<uint8_t>(~taken[i]);
  }
  task.outputs.mark(tables_->waiting_mask);
  task.held = task.outputs.waits();
  task.unsent = true;
}

// B6: results of a period are sent in the first cycle of the next one.
void Scheduler::take_waiting_outputs() {
  for (TaskSlot& task : tables_->tasks) {
    if (task.synchronous() && task.next_release_ns <= cycle_start_ns_) take_outputs(task);
  }
}

// B5: with each transmission of a cycle.
void Scheduler::take_sendable_outputs() {
  for (TaskSlot& task : tables_->tasks) {
    if (!task.synchronous()) take_outputs(task);
  }
}

void Scheduler::send_outputs() {
  take_sendable_outputs();
  transmit();
}

void Scheduler::transmit() {
  io_.send(tables_->outputs);
  std::copy_n(tables_->outputs.begin(), tables_->sent_outputs.size(),
              tables_->sent_outputs.begin());
}

// B12. What other tasks read stays what it was: only this one's buffer gets it.
void Scheduler::receive_for(TaskSlot& task) {
  if (tables_->newest_inputs.empty()) return;
  io_.receive(tables_->newest_inputs);
  note(Moment::kReceived, task, looked_ns_);
  look_at_losses();
  task.inputs.write(tables_->newest_inputs, looked_ns_);
}

// B12. What other tasks have written waits for the cycle: it stays as it was sent last.
void Scheduler::send_of(TaskSlot& task) {
  base::Bytes& sent = tables_->sent_outputs;
  if (sent.empty()) return;
  take_outputs(task);
  merge(sent, tables_->outputs, tables_->written);
  if (impose_on_outputs()) merge(sent, tables_->outputs, tables_->forced_outputs);
  io_.send(sent);
  task.unsent = false;
  show(task);
  note(Moment::kSent, task, looked_ns_);
  note(Moment::kOutputsOf, task, looked_ns_);
}

}  // namespace vm
