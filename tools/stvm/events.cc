// stvm events: what happens to a running controller, as it happens.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_filter.h"
#include "tools/stvm/event_text.h"
#include "tools/stvm/state_journal.h"
#include "tools/stvm/stop_signal.h"

namespace stvm {
namespace {

using online_change::JournalEntry;
using Entries = std::vector<JournalEntry>;

constexpr std::chrono::milliseconds kFollowLook{100};

constexpr tools::OptionRow kEventsOptions[] = {
    {"--follow|-f", nullptr, "go on with each new event, until the controller ends"},
    {"--since", "TIME",
     "events from then on: 2026-03-01T08:00:00 (UTC), or 90s, 10m, 1h30m, 2d ago"},
    {"--level", "LEVEL", "at least that serious (default: info, which is all)",
     "error|warning|notice|info"},
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kEventsCommand{
    "events",
    "",
    "Shows what happens to a running controller: starts, changes, traps, overruns, devices, "
    "forces\n"
    "and writes; oldest first. Those of before it started come from its journal.",
    kEventsOptions,
    0,
    0};

class Shown {
 public:
  Shown(const EventFilter& filter, bool json) : filter_(filter), json_(json) {}

  void print(const Entries& entries) {
    for (const JournalEntry& entry : entries) print(entry);
    std::fflush(stdout);
  }
  void print(const JournalEntry& entry) {
    if (event_row(entry.event).kept != online_change::Kept::kMemory) newest_durable_ = entry;
    if (!filter_.shows(entry)) return;
    const std::string text =
        json_ ? event_json_line(entry)
              : log_line(event_row(entry.event).level, entry.time_ns, event_text(entry), false);
    std::fputs(text.c_str(), stdout);
  }
  // Prints of `all`, oldest first, what has come after the newest durable one that was printed.
  void print_rest(const Entries& all) {
    const auto same = [&](const JournalEntry& entry) {
      return newest_durable_ && entry.event == newest_durable_->event &&
             entry.time_ns == newest_durable_->time_ns && entry.text == newest_durable_->text;
    };
    const auto newest = std::find_if(all.rbegin(), all.rend(), same);
    if (newest != all.rend()) print({newest.base(), all.end()});
  }

 private:
  EventFilter filter_;
  bool json_;
  std::optional<JournalEntry> newest_durable_;
};

// The controller forgets the oldest ones: those that nobody has fetched in time.
void say_missing(const Entries& entries, uint64_t wanted) {
  if (wanted == 0 || entries.empty() || entries.front().sequence == wanted) return;
  std::fprintf(stderr, "%llu events are missing here: the controller has forgotten them\n",
               static_cast<unsigned long long>(entries.front().sequence - wanted));
}

// Until somebody interrupts it, or the controller ends: of a controller on this machine, what it
// has noted last is in its journal.
base::Status follow(const tools::Options& options, ControllerClient& client, Shown& shown) {
  StopSignal::install();
  for (uint64_t next = 0; !StopSignal::received() && std::ferror(stdout) == 0;) {
    base::Result<Entries> entries = client.events(next);
    if (!entries.ok() && (next == 0 || entries.error().refusal != base::Refusal::kNotRunning)) {
      return entries.error();
    }
    if (!entries.ok()) {
      const auto stored =
          options.has("--host") ? Entries() : stored_events(state_directory(options));
      if (stored.ok()) shown.print_rest(*stored);
      std::fputs("the controller has ended\n", stderr);
      return base::Ok{};
    }
    say_missing(*entries, next);
    shown.print(*entries);
    if (!entries->empty()) next = entries->back().sequence + 1;
    std::this_thread::sleep_for(kFollowLook);
  }
  return base::Ok{};
}

base::Status show_events(const tools::Options& options) {
  base::Result<EventFilter> filter =
      EventFilter::parse(options.text("--since"), options.text("--level"), wall_time_ns());
  if (!filter.ok()) return filter.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  Shown shown(*filter, wants_json(options));
  if (options.has("--follow")) return follow(options, *client, shown);
  base::Result<Entries> entries = client->events(0);
  if (!entries.ok()) return entries.error();
  if (!wants_json(options)) {
    shown.print(*entries);
  } else {
    std::erase_if(*entries, [&](const JournalEntry& entry) { return !filter->shows(entry); });
    std::fputs(events_json(*entries).c_str(), stdout);
  }
  return base::Ok{};
}

int run_events(const tools::Options& options) {
  base::Status shown = show_events(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kEvents{&kEventsCommand, run_events};

}  // namespace stvm
