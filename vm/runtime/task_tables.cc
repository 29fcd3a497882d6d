#include "vm/runtime/task_tables.h"

#include <algorithm>
#include <numeric>

#include "ir/bytecode/renames.h"

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
  const bool no_period = task.event != 0 || task.once;
  slot.status.period_ns = std::max<int64_t>(task.period_ns, no_period ? 0 : 1);
  slot.status.priority = task.priority;
  slot.watchdog_ns = task.watchdog_ns > 0 ? task.watchdog_ns : 10 * slot.status.period_ns;
  slot.programs = task.programs;
  slot.execution = std::make_unique<Execution>(image.call_depth, number, try_depth);
  slot.inputs.resize(image.input_bytes);
  slot.outputs_at_start.resize(image.output_bytes);
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

// Bytes that stand for the same value in the other image; empty when there are none.
base::Bytes carry_over(const ir::Image& from, const Force& force, const ir::Image& to,
                       const ir::Symbol& symbol) {
  bool same_type = from.types.text(force.symbol.type) == to.types.text(symbol.type);
  if (same_type && from.types[force.symbol.type].kind != ir::Kind::kEnum) return force.value;
  ir::Symbol alone = force.symbol;
  alone.data = 0;
  std::string text = ir::format_value(from, alone, force.value);
  base::Result<base::Bytes> value = ir::parse_value(to, symbol.type, text);
  return value.ok() ? *value : base::Bytes{};
}

// Paths of one version's variables in the other one, whichever of them renames (case 47).
class RenamedPaths {
 public:
  RenamedPaths(const ir::Image& from, const ir::Image& to)
      : from_(from), to_(to), there_(from, to), back_(to, from) {}

  std::string find(const Force& force) const {
    if (!there_.renamed() && !back_.renamed()) return force.path;
    const std::string before = ir::path_of(from_, force.symbol);
    std::string after;
    if (there_.renamed()) {
      after = ir::path_of(there_.image(), force.symbol);
    } else {
      base::Result<ir::Symbol> symbol = ir::find_symbol(back_.image(), before);
      if (symbol.ok()) after = ir::path_of(to_, *symbol);
    }
    return before == after ? force.path : after;
  }

 private:
  const ir::Image& from_;
  const ir::Image& to_;
  ir::OldUnderNewNames there_;
  ir::OldUnderNewNames back_;
};

}  // namespace

TaskTables::TaskTables(const Generation& made_for, int64_t first_release_ns)
    : generation(&made_for), version(made_for.verified()), process_image(made_for.image()) {
  const ir::Image& image = made_for.image();
  for (uint32_t number = 0; number < image.tasks.size(); ++number) {
    by_priority.push_back(number);
    tasks.push_back(make_slot(made_for, number, first_release_ns));
  }
  std::stable_sort(by_priority.begin(), by_priority.end(), [&](uint32_t a, uint32_t b) {
    return tasks[a].status.priority < tasks[b].status.priority;
  });
  inputs.resize(image.input_bytes);
  outputs.resize(image.output_bytes);
  scratch.resize(image.output_bytes);
  set_base_period();
}

void TaskTables::adopt(const TaskTables& previous, int64_t cycle_start_ns) {
  for (TaskSlot& slot : tasks) {
    slot.released = false;
    slot.next_release_ns = previous.next_cycle_ns(cycle_start_ns);
    for (const TaskSlot& old : previous.tasks) {
      slot.execution->count_on(*old.execution);
      if (!ir::same_name(slot.status.name, old.status.name)) continue;
      // Not as a whole: at a boundary nothing is allocated, and a name can be long.
      slot.status.scans = old.status.scans;
      slot.status.missed = old.status.missed;
      slot.status.last_ns = old.status.last_ns;
      slot.status.max_ns = old.status.max_ns;
      slot.status.stopped = old.status.stopped;
      slot.released = old.released;
      slot.event_level = old.event_level;
      keep_phase(slot, old, cycle_start_ns);
    }
  }
  std::copy_n(previous.inputs.begin(), std::min(inputs.size(), previous.inputs.size()),
              inputs.begin());
  set_base_period();
}

void TaskTables::set_base_period() {
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

void TaskTables::adopt_forces(const ir::Image& from, const std::vector<Force>& rows) {
  const ir::Image& to = version.image();
  forces.clear();
  ended_forces.clear();
  if (rows.empty()) return;
  const RenamedPaths paths(from, to);
  for (const Force& row : rows) {
    Force force = row;
    force.path = paths.find(row);
    base::Result<ir::Symbol> symbol = ir::find_symbol(to, force.path);
    base::Bytes value;
    if (symbol.ok() && !symbol->constant) value = carry_over(from, force, to, *symbol);
    if (value.empty()) {
      ended_forces.push_back(row.path);
    } else {
      forces.push_back({force.path, *symbol, std::move(value)});
    }
  }
}

}  // namespace vm
