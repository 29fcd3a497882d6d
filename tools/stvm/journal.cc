// stvm journal: what happened to a controller, from its state directory, where it need not run; on
// another machine, from the controller.
#include <cstdio>

#include "online_change/store/store.h"
#include "tools/common/exit.h"
#include "tools/common/fate_report.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"
#include "vm/runtime/file_storage.h"

namespace stvm {
namespace {

using online_change::Event;
using online_change::JournalEntry;

constexpr tools::OptionRow kJournalOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kJournalCommand{
    "journal",       "", "Shows who changed what and when, power cuts, and traps; oldest first.",
    kJournalOptions, 0,  0};

base::Result<std::vector<JournalEntry>> entries_in(const std::string& directory) {
  vm::FileStorage storage(directory);
  auto entries = online_change::read_journal(storage, online_change::kJournalFile);
  if (!entries.ok()) return entries.error();
  auto traps = online_change::read_journal(storage, online_change::kTrapsFile);
  if (!traps.ok()) return traps.error();
  return online_change::by_time(std::move(*entries), std::move(*traps));
}

base::Result<std::vector<JournalEntry>> entries_of(const tools::Options& options) {
  if (!options.has("--host")) return entries_in(state_directory(options));
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  return client->journal();
}

std::string version_text(const JournalEntry& entry) {
  const base::Digest none{};
  std::string out;
  if (entry.from != none) out += " " + base::short_hex(entry.from);
  if (entry.from != none && entry.to != none) out += " ->";
  if (entry.to != none) out += " " + base::short_hex(entry.to);
  return out;
}

// Nothing in a file may speak to a terminal.
std::string printable(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return text;
}

std::string counts_text(const online_change::FateCounts& n) {
  return std::to_string(n.kept) + " kept, " + std::to_string(n.moved) + " moved, " +
         std::to_string(n.converted) + " converted, " + std::to_string(n.initialised) +
         " initialised, " + std::to_string(n.dropped) + " dropped";
}

// One line, and what there is to say of it below, so that it fits a terminal.
void print_journal_text(const std::vector<JournalEntry>& entries) {
  for (const JournalEntry& entry : entries) {
    std::printf("%s  %s%s%s%s\n", time_text(entry.time_ns).c_str(), event_name(entry.event),
                version_text(entry).c_str(), entry.who.empty() ? "" : "  by ",
                printable(entry.who).c_str());
    std::vector<std::string> below;
    if (entry.counts.total() != 0) below.push_back(counts_text(entry.counts));
    std::string pause;
    if (entry.measured_ns != 0) pause = "pause " + tools::duration(entry.measured_ns);
    if (entry.predicted_ns != 0) {
      pause += (pause.empty() ? "expected " : ", expected ") + tools::duration(entry.predicted_ns);
    }
    if (!pause.empty()) below.push_back(pause);
    if (entry.event == Event::kTrap) below.push_back("cycle " + std::to_string(entry.cycle));
    if (!entry.text.empty()) below.push_back(printable(entry.text));
    for (const std::string& line : below) std::printf("    %s\n", line.c_str());
  }
}

void print_journal_json(const std::vector<JournalEntry>& entries) {
  tools::JsonWriter json;
  json.begin_array();
  for (const JournalEntry& entry : entries) {
    json.begin_object().field("time", time_text(entry.time_ns)).field("time_ns", entry.time_ns);
    json.field("event", event_name(entry.event)).field("who", entry.who);
    json.field("from", base::to_hex(entry.from)).field("to", base::to_hex(entry.to));
    json.key("fates").begin_object().field("kept", entry.counts.kept);
    json.field("moved", entry.counts.moved).field("converted", entry.counts.converted);
    json.field("initialised", entry.counts.initialised).field("dropped", entry.counts.dropped);
    json.end_object().field("predicted_pause_ns", entry.predicted_ns);
    json.field("pause_ns", entry.measured_ns).field("cycle", entry.cycle);
    json.field("text", entry.text).end_object();
  }
  json.end_array();
  std::fputs(json.finish().c_str(), stdout);
}

base::Status show_journal(const tools::Options& options) {
  const bool json = wants_json(options);
  auto entries = entries_of(options);
  if (!entries.ok()) return entries.error();
  (json ? print_journal_json : print_journal_text)(*entries);
  return base::Ok{};
}

int run_journal(const tools::Options& options) {
  base::Status shown = show_journal(options);
  return shown.ok() ? tools::kOk : refuse(shown.error());
}

}  // namespace

const Entry kJournal{&kJournalCommand, run_journal};

}  // namespace stvm
