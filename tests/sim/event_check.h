// What the event log tells of the plant's bad luck: each thing by one event, with its place
// and its time, and what comes too often by a count. Nothing is missing, and nothing is told twice.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/stvm/event_log.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace sim {

using online_change::Event;
using online_change::JournalEntry;

// From one boot to the next power cut.
class EventCheck {
 public:
  // `store` and `clock` outlive it.
  EventCheck(online_change::Store& store, vm::Clock& clock);

  vm::EventRing& ring() { return log_.ring(); }
  vm::DeviceLog device_log();
  int64_t wall_ns() const { return clocks_.wall_ns(); }

  // One event shall tell of it, with this source and, if given, this text.
  void happened(Event event, const std::string& source = {}, const std::string& text = {});
  // What a request has become on its way, and how often it comes, nobody knows.
  void any_refusal() { any_refusal_ = true; }
  // One of several: a switch that leads to the version before is a change or an undo.
  void switched() { ++switches_; }
  // What has been told so far is what has happened.
  void check(const vm::Controller& controller, bool unsaved);
  // As check(), but for what an operation was about to tell that the power cut has ended; then what
  // was left out is counted, too.
  void end(const vm::Controller& controller);

 private:
  struct Clocks : stvm::EventLog::Clocks {
    explicit Clocks(vm::Clock& plant) : clock(plant) {}
    int64_t wall_ns() const override;
    int64_t steady_ns() const override { return clock.now_ns(); }
    vm::Clock& clock;
  };
  struct Expected {
    Event event;
    std::string source;
    std::string text;
  };

  void take_news(const vm::Controller& controller);
  void take(const JournalEntry& entry, const vm::Controller& controller);
  bool take_expected(const JournalEntry& entry);
  void check_place(const JournalEntry& entry, const vm::Controller& controller) const;

  Clocks clocks_;
  stvm::EventLog log_;
  uint64_t next_ = 1;
  int64_t looked_ns_ = 0;  // wall time
  std::vector<Expected> expected_;
  bool any_refusal_ = false;
  uint64_t switches_ = 0;
  uint64_t told_switches_ = 0;
  uint64_t told_traps_ = 0;  // those that were left out included
  // By event and source, of what may be left out.
  std::map<std::pair<Event, std::string>, uint64_t> happened_;
  std::map<std::pair<Event, std::string>, uint64_t> told_;
  int unsaved_ = 0;  // alarms that retained values are not saved, without those that are over
};

}  // namespace sim
