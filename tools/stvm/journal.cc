// stvm journal: what happened to a controller, from its state directory, where it need not run; on
// another machine, from the controller.
#include <cstdio>

#include "base/visible_text.h"
#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/event_text.h"
#include "tools/stvm/state_journal.h"

namespace stvm {
namespace {

using online_change::Event;
using online_change::JournalEntry;

constexpr tools::OptionRow kJournalOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kJournalCommand{
    "journal",
    "",
    "Shows the events that outlive a controller, which need not run: who changed or forced what\n"
    "and when, power cuts, and traps; oldest first. `stvm events` shows all of one that runs.",
    kJournalOptions,
    0,
    0};

base::Result<std::vector<JournalEntry>> entries_of(const tools::Options& options) {
  if (!options.has("--host")) return stored_events(state_directory(options));
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  return client->journal();
}

// One line, and what there is to say of it below, so that it fits a terminal.
void print_journal_text(const std::vector<JournalEntry>& entries) {
  for (const JournalEntry& entry : entries) {
    std::printf("%s  %s%s%s%s\n", time_text(entry.time_ns).c_str(), event_name(entry.event),
                versions_text(entry).c_str(), entry.who.empty() ? "" : "  by ",
                base::visible(entry.who).c_str());
    std::vector<std::string> below{counts_text(entry.counts), pause_text(entry)};
    const bool scan = entry.event == Event::kTrap || entry.event == Event::kWatchdog;
    if (scan && entry.cycle != 0) below.push_back("cycle " + std::to_string(entry.cycle));
    below.push_back(what_text(entry));
    std::erase(below, "");
    for (const std::string& line : below) std::printf("    %s\n", line.c_str());
  }
}

base::Status show_journal(const tools::Options& options) {
  auto entries = entries_of(options);
  if (!entries.ok()) return entries.error();
  if (!wants_json(options)) {
    print_journal_text(*entries);
  } else {
    std::fputs(events_json(*entries).c_str(), stdout);
  }
  return base::Ok{};
}

int run_journal(const tools::Options& options) {
  base::Status shown = show_journal(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kJournal{&kJournalCommand, run_journal};

}  // namespace stvm
