// What the scheduler tells of scans that go wrong: records of traps, and events for others to
// write.
#include "base/memory_limit.h"
#include "vm/runtime/event_ring.h"
#include "vm/runtime/scheduler.h"

namespace vm {
namespace {

void tell_trap(EventRing& events, std::string_view task, const TrapRecord& trap, ir::TrapKind what,
               const base::Digest& version) {
  const bool late = what == ir::TrapKind::kWatchdog;
  ScanEvent* const event = events.begin(late ? ScanEventKind::kWatchdog : ScanEventKind::kTrap);
  if (event == nullptr) return;
  event->cycle = trap.cycle;
  event->version = version;
  event->source.add("task ").add(task);
  event->text.add(trap.text.file).add(":").add(trap.text.line).add(" (").add(trap.text.pou);
  event->text.add("): ").add(trap.text.text);
  events.end();
}

}  // namespace

// Where memory has run out, the trap has a record without a text that was made before.
void Scheduler::note_trap(const TaskSlot& task, const Trap& trap) {
  ++trap_count_;
  const auto record = [&]() -> std::shared_ptr<const TrapRecord> {
    return std::make_shared<TrapRecord>(
        TrapRecord{cycles_, task.status.name, trap, describe(tables_->generation->image(), trap)});
  };
  auto made = base::within_memory(record, [this] { return without_text_; });
  if (options_.events != nullptr) {
    tell_trap(*options_.events, task.status.name, *made, trap.kind, tables_->version.digest());
  }
  if (traps_.size() == kKeptTraps) traps_.erase(traps_.begin());
  traps_.push_back(std::move(made));  // there is room: the constructor
}

void Scheduler::note_overrun(TaskSlot& task) {
  ++task.status.overruns;
  task.late = true;
  show(task);
  EventRing* const events = options_.events;
  ScanEvent* const event = events != nullptr ? events->begin(ScanEventKind::kOverrun) : nullptr;
  if (event == nullptr) return;
  event->cycle = cycles_;
  event->source.add("task ").add(task.status.name);
  event->text.add("it was due while its scan before was not done");
  events->end();
}

}  // namespace vm
