#include "tests/sim/event_check.h"

#include <algorithm>
#include <cstdlib>

#include "online_change/store/record.h"
#include "tests/sim/violation.h"
#include "tools/stvm/event_text.h"

namespace sim {
namespace {

constexpr int64_t kEpochNs = 1'700'000'000'000'000'000;
constexpr size_t kPageBytes = 1 << 20;

bool of_scans(Event event) {
  return event == Event::kTrap || event == Event::kWatchdog || event == Event::kOverrun;
}

bool begins(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

// "... and 37 more like this in 10 s" -> 37; 0: it is an event by itself.
uint64_t left_out(const JournalEntry& entry) {
  const std::string head = "... and ";
  if (!begins(entry.text, head)) return 0;
  return std::strtoull(entry.text.c_str() + head.size(), nullptr, 10);
}

}  // namespace

int64_t EventCheck::Clocks::wall_ns() const { return kEpochNs + clock.now_ns(); }

EventCheck::EventCheck(online_change::Store& store, vm::Clock& clock)
    : clocks_(clock), log_(store, {}, nullptr, clocks_), looked_ns_(clocks_.wall_ns()) {
  for (base::Bytes page; !(page = log_.page(next_, kPageBytes)).empty();) {
    next_ += page.size() / online_change::kSectorBytes;
  }
}

vm::DeviceLog EventCheck::device_log() {
  return [this](vm::DeviceEvent event, const std::string& device, const std::string& text) {
    log_.take_device(event, device, text);
  };
}

void EventCheck::happened(Event event, const std::string& source, const std::string& text) {
  if (online_change::event_row(event).limit == online_change::Limit::kNone) {
    expected_.push_back({event, source, text});
  } else {
    ++happened_[{event, source}];
  }
}

bool EventCheck::take_expected(const JournalEntry& entry) {
  const auto found = std::find_if(expected_.begin(), expected_.end(), [&](const Expected& row) {
    return row.event == entry.event && row.source == entry.source &&
           (row.text.empty() || (!entry.text.empty() && begins(row.text, entry.text)));
  });
  if (found == expected_.end()) return false;
  expected_.erase(found);
  return true;
}

// A trap is where the record of the controller says that it was.
void EventCheck::check_place(const JournalEntry& entry, const vm::Controller& controller) const {
  require(begins(entry.source, "task "), "a trap is of a task: " + entry.source);
  require(entry.cycle <= controller.cycles(), "a trap has been: " + entry.text);
  const vm::Traps& traps = controller.traps();
  if (traps.empty() || (*traps.begin())->cycle > entry.cycle) return;  // forgotten
  const bool known = std::any_of(traps.begin(), traps.end(), [&](const auto& trap) {
    const std::string place = trap->text.file + ":" + std::to_string(trap->text.line) + " (" +
                              trap->text.pou + "): " + trap->text.text;
    return trap->cycle == entry.cycle && "task " + trap->task == entry.source &&
           begins(place, entry.text);
  });
  require(known, "a trap that was told is one that was: " + stvm::event_text(entry));
}

void EventCheck::take(const JournalEntry& entry, const vm::Controller& controller) {
  const std::string text = stvm::event_text(entry);
  if (!of_scans(entry.event)) {  // those have the time of the machine
    require(entry.time_ns >= looked_ns_ && entry.time_ns <= clocks_.wall_ns(),
            "an event has the time at which it was: " + text);
  }
  const uint64_t more = left_out(entry);
  const uint64_t count = std::max<uint64_t>(more, 1);
  if (entry.event == Event::kTrap || entry.event == Event::kWatchdog) {
    told_traps_ += count;
    if (more == 0) check_place(entry, controller);
  } else if (entry.event == Event::kSwitched || entry.event == Event::kUndone) {
    ++told_switches_;
    require(begins(entry.text, "edit "), "a switch names its edit: " + text);
    require(entry.cycle <= controller.cycles() + 1, "and its cycle: " + text);
  } else if (entry.event == Event::kAlarm && begins(entry.text, "retained values are not")) {
    ++unsaved_;
  } else if (entry.event == Event::kCleared && begins(entry.text, "retained values are saved")) {
    --unsaved_;
  } else if (online_change::event_row(entry.event).limit != online_change::Limit::kNone) {
    told_[{entry.event, entry.source}] += count;
  } else if (!take_expected(entry)) {
    const bool bad_luck = entry.event == Event::kStarted || entry.event == Event::kResumed ||
                          entry.event == Event::kTrialLost ||
                          (entry.event == Event::kRefused && !any_refusal_);
    require(!bad_luck, "nothing is told that has not happened: " + text);
  }
}

void EventCheck::take_news(const vm::Controller& controller) {
  log_.look();
  for (base::Bytes page; !(page = log_.page(next_, kPageBytes)).empty();) {
    for (size_t at = 0; at < page.size(); at += online_change::kSectorBytes) {
      const auto entry = online_change::decode_entry(
          base::ByteSpan(page).subspan(at, online_change::kSectorBytes));
      require(entry.has_value() && entry->sequence == next_++, "events have numbers in order");
      take(*entry, controller);
    }
  }
}

void EventCheck::check(const vm::Controller& controller, bool unsaved) {
  take_news(controller);
  any_refusal_ = false;
  looked_ns_ = clocks_.wall_ns();
  for (const Expected& row : expected_) {
    require(false, std::string("not told: ") + online_change::event_row(row.event).name + " " +
                       row.source + " " + row.text);
  }
  require(told_switches_ == switches_, std::to_string(switches_) +
                                           " switches and undos have been, and " +
                                           std::to_string(told_switches_) + " were told");
  require(told_traps_ <= controller.trap_count(), "no trap is told twice");
  require(told_traps_ != 0 || controller.trap_count() == 0, "the first trap is told");
  require(unsaved_ == (unsaved ? 1 : 0),
          "that retained values are not saved is told once, and when they are again");
  for (const auto& [what, count] : happened_) {
    require(told_[what] <= count && told_[what] != 0, "what a device did is told: " + what.second);
  }
}

void EventCheck::end(const vm::Controller& controller) {
  log_.close();
  expected_.clear();
  any_refusal_ = true;
  take_news(controller);
  require(told_traps_ == controller.trap_count(),
          std::to_string(controller.trap_count()) + " traps have been, and " +
              std::to_string(told_traps_) + " were told or counted");
  for (const auto& [what, count] : happened_) {
    require(told_[what] == count, "what was left out of `" + what.second + "` is counted");
  }
}

}  // namespace sim
