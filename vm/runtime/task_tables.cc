#include "vm/runtime/task_tables.h"

#include <algorithm>
#include <numeric>

#include "base/limits.h"
#include "vm/runtime/own_outputs.h"

namespace vm {
namespace {

// An image without tasks still refreshes its process image.
constexpr int64_t kIdlePeriodNs = 10'000'000;

TaskSlot make_slot(const Generation& generation, uint32_t number, int64_t first_release_ns) {
  const ir::Image& image = generation.image();
  const uint32_t try_depth = generation.try_depth();
  const ir::ImageTask& task = image.tasks[number];
  TaskSlot slot;
  slot.status.name = task.name;
  const bool no_period = task.event != 0 || task.once || task.policy.freewheeling;
  slot.status.period_ns = std::max<int64_t>(task.period_ns, no_period ? 0 : 1);
  slot.status.priority = task.priority;
  slot.watchdog_ns = task.watchdog_ns > 0 ? task.watchdog_ns : 10 * slot.status.period_ns;
  slot.programs = task.programs;
  slot.execution = std::make_unique<Execution>(image.call_depth, number, try_depth);
  slot.policy = task.policy;
  slot.status.freewheeling = task.policy.freewheeling;
  slot.inputs = InputSync(task.policy.input_buffer, image.input_bytes);
  for (base::Bytes* bytes : {&slot.outputs_at_start, &slot.own_outputs}) {
    bytes->resize(image.output_bytes);
  }
  const bool buffered = task.policy.output_buffer != ir::IoBuffer::kCopied;
  if (buffered || slot.synchronous() || slot.exchanges()) {
    slot.outputs = OutputSync(task.policy.output_buffer, image.output_bytes);
  }
  slot.next_release_ns = first_release_ns;
  slot.once = slot.status.once = task.once;
  slot.event = task.event;
  for (const ir::IoBinding& binding : image.io) {
    bool input = binding.address.area == ir::DirectArea::kInput && binding.data == task.event;
    if (!input || task.event == 0) continue;
    slot.event_byte = binding.address.bit_offset / 8;
    slot.event_mask = static_cast<uint8_t>(1u << (binding.address.bit_offset % 8));
  }
  return slot;
}

void keep_phase(TaskSlot& slot, const TaskSlot& old, int64_t cycle_start_ns) {
  if (slot.status.period_ns == 0 || old.status.period_ns == 0) return;
  int64_t last_release = old.next_release_ns - old.status.period_ns;
  int64_t period = slot.status.period_ns;
  slot.next_release_ns = last_release + period;
  if (slot.next_release_ns <= cycle_start_ns) {
    int64_t behind = cycle_start_ns - slot.next_release_ns;
    slot.next_release_ns += (behind / period + 1) * period;
  }
}

// The task was late before its scan could even begin, and the scan will have the policy of the new
// version. A start that was to come at once has no scan then.
void keep_overrun(TaskSlot& slot, const TaskSlot& old) {
  const bool same = slot.policy.overrun == old.policy.overrun;
  slot.due_again = same && old.due_again;
  slot.due_again_ns = old.due_again_ns;
  const bool left_out = !same && old.due_again && old.policy.overrun == ir::Overrun::kAtOnce;
  slot.status.missed += left_out ? 1 : 0;
}

}  // namespace

BufferState TaskSlot::output_state() const {
  const bool scan = state == TaskState::kRunning || state == TaskState::kSuspended;
  return outputs.state(unsent || held, scan);
}

TaskTables::TaskTables(const Generation& made_for, int64_t first_release_ns)
    : generation(&made_for),
      own_code(made_for.code()),
      code(own_code.get()),
      version(made_for.verified()),
      schedule(made_for.image().schedule),
      process_image(made_for.image()),
      shared(made_for.image()),
      safe(made_for.image()),
      lost(made_for.image().tasks.size()) {
  const ir::Image& image = made_for.image();
  for (uint32_t number = 0; number < image.tasks.size(); ++number) {
    by_priority.push_back(number);
    tasks.push_back(make_slot(made_for, number, first_release_ns));
  }
  std::stable_sort(by_priority.begin(), by_priority.end(), [&](uint32_t a, uint32_t b) {
    return tasks[a].status.priority < tasks[b].status.priority;
  });
  inputs.resize(image.input_bytes);
  seen_inputs.resize(image.input_bytes);
  for (base::Bytes* bytes :
       {&outputs, &unused, &waiting_mask, &written, &scratch, &forced_outputs}) {
    bytes->resize(image.output_bytes);
  }
  plain_outputs = !process_image.has_reals();
  for (const TaskSlot& slot : tasks) {
    plain_outputs = plain_outputs && !slot.outputs.used();
    if (!slot.exchanges()) continue;
    newest_inputs.resize(image.input_bytes);
    sent_outputs.resize(image.output_bytes);
  }
  process_image.mark_outputs(0, UINT32_MAX, unused);
  for (uint8_t& bits : unused) bits = static_cast<uint8_t>(~bits);
  if (image.output_bytes != 0) mark_own_outputs(*this);
  set_base_period();
}

void TaskTables::adopt(TaskTables& previous, int64_t cycle_start_ns) {
  std::fill(waiting_mask.begin(), waiting_mask.end(), uint8_t{0});
  previous.forced.moved.back = forced.moved.ended;
  std::copy_n(previous.inputs.begin(), std::min(inputs.size(), previous.inputs.size()),
              inputs.begin());
  const base::Bytes& received =
      previous.newest_inputs.empty() ? previous.inputs : previous.newest_inputs;
  std::copy_n(received.begin(), std::min(newest_inputs.size(), received.size()),
              newest_inputs.begin());
  // What has lost its variable becomes safe with the next refresh; the rest is packed then (case
  // 46).
  std::fill(outputs.begin(), outputs.end(), uint8_t{0});
  std::copy_n(previous.outputs.begin(), std::min(outputs.size(), previous.outputs.size()),
              outputs.begin());
  safe.adopt_holds(previous.safe);
  for (size_t i = 0; i < written.size(); ++i) {
    const bool there = i < previous.unused.size();
    written[i] = static_cast<uint8_t>(unused[i] & ~(there ? previous.unused[i] : 0));
  }
  safe.apply(written, cycle_start_ns, outputs);
  std::copy_n(outputs.begin(), sent_outputs.size(), sent_outputs.begin());
  for (TaskSlot& slot : tasks) {
    slot.outputs.restart();
    slot.unsent = slot.held = false;
    slot.released = slot.due_again = slot.overran = slot.io_lost = false;
    slot.next_release_ns = previous.next_cycle_ns(cycle_start_ns);
    for (TaskSlot& old : previous.tasks) {
      slot.execution->count_on(*old.execution);
      if (!ir::same_name(slot.status.name, old.status.name)) continue;
      // Not as a whole: at a boundary nothing is allocated, and a name can be long.
      slot.status.scans = old.status.scans;
      slot.status.overruns = old.status.overruns;
      slot.status.missed = old.status.missed;
      slot.status.last_ns = old.status.last_ns;
      std::swap(slot.times, old.times);
      slot.status.stopped = old.status.stopped;
      slot.released = old.released;
      slot.event_level = old.event_level;
      slot.released_ns = old.released_ns;
      keep_overrun(slot, old);
      slot.io_lost = old.io_lost;
      slot.late = old.late;
      keep_phase(slot, old, cycle_start_ns);
      if (same_outputs) keep_outputs(slot, old);
      keep_inputs(slot, old);
    }
  }
  // Tasks come and go, some of them with counters from before: the sum goes on.
  missed_before = 0;
  missed_before = previous.missed_releases() - missed_releases();
  set_base_period();
}

// At a boundary, where nothing is allocated. Without it, what waits goes out with the first cycle.
void TaskTables::keep_outputs(TaskSlot& slot, TaskSlot& old) {
  for (size_t i = 0; i < waiting_mask.size(); ++i) slot.own_outputs[i] |= old.own_outputs[i];
  const bool both = slot.outputs.used() && old.outputs.used();
  if (!both || slot.synchronous() != old.synchronous()) return;
  slot.outputs.keep(old.outputs);
  slot.held = old.held;
  slot.outputs.mark(waiting_mask);
}

// What has been received for a scan that is still to come. Tables that rested have old inputs.
void TaskTables::keep_inputs(TaskSlot& slot, TaskSlot& old) {
  if (slot.inputs.like(old.inputs)) {
    std::swap(slot.inputs, old.inputs);
  } else {
    slot.inputs.restart();
    slot.inputs.write(inputs, old.inputs.received_ns());
  }
}

void TaskTables::compare_outputs(TaskTables& a, TaskTables& b) {
  const bool same =
      a.outputs.size() == b.outputs.size() && a.process_image.same_outputs(b.process_image);
  a.same_outputs = b.same_outputs = same;
}

uint64_t TaskTables::missed_releases() const {
  uint64_t missed = missed_before;
  for (const TaskSlot& task : tasks) missed += task.status.missed;
  return missed;
}

uint64_t TaskTables::load() const {
  uint64_t load = 0;
  for (const TaskSlot& task : tasks) {
    const TaskStatus& status = task.status;
    if (status.period_ns <= 0 || status.last_ns <= 0) continue;
    load += static_cast<uint64_t>(status.last_ns) * 1000 / static_cast<uint64_t>(status.period_ns);
  }
  return load;
}

// Phases that a change left between periods that do not fit could make the cycle too short: then
// all tasks get one phase.
void TaskTables::set_base_period() {
  find_base_period();
  if (base_period_ns >= static_cast<int64_t>(base::kMinBaseCycleNs)) return;
  const int64_t first = next_release_ns();
  for (TaskSlot& slot : tasks) slot.next_release_ns = first;
  find_base_period();
}

void TaskTables::find_base_period() {
  base_period_ns = 0;
  for (const TaskSlot& slot : tasks) {
    if (slot.status.period_ns == 0) continue;
    base_period_ns = std::gcd(base_period_ns, slot.status.period_ns);
    base_period_ns = std::gcd(base_period_ns, slot.next_release_ns - tasks.front().next_release_ns);
  }
  if (base_period_ns == 0) base_period_ns = kIdlePeriodNs;
}

int64_t TaskTables::next_release_ns() const {
  int64_t next = INT64_MAX;
  for (const TaskSlot& slot : tasks) {
    bool periodic = slot.status.period_ns != 0;
    if (periodic && !slot.status.stopped) next = std::min(next, slot.next_release_ns);
  }
  return next;
}

int64_t TaskTables::next_cycle_ns(int64_t cycle_start_ns) const {
  if (tasks.empty()) return cycle_start_ns + base_period_ns;
  int64_t distance = (tasks.front().next_release_ns - cycle_start_ns) % base_period_ns;
  return cycle_start_ns + (distance > 0 ? distance : base_period_ns + distance);
}

ForcedSet TaskTables::adopted_forces(const ir::Image& from, const std::vector<Force>& forces,
                                     const TierOptions& tier, ForceList back) const {
  return ForcedSet::adopt(version, *own_code, from, forces, tier, std::move(back));
}

void TaskTables::exchange_forces(ForcedSet& set) {
  std::swap(forced, set);
  code = forced.code == nullptr ? own_code.get() : &forced.code->table();
}

}  // namespace vm
