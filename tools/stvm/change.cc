// stvm change: a new program for a running controller. Fetch what runs, let stc make the package,
// show every variable's fate, ask, switch.
#include <unistd.h>

#include <cstdio>
#include <iostream>

#include "tools/common/change_settings.h"
#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/fate_report.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/table.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/switch_text.h"
#include "vm/io/global_exchange.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {
    STVM_CONTROLLER_OPTIONS,
    {"--yes", nullptr, "switch without asking"},
    {"--dry-run", nullptr, "stop after the fate report; nothing is changed"},
    {"--allow-loss", nullptr, "switch even if live values are lost, as the report says"},
    {"--strategy", "S",
     "in-place (default, or what the project says), or standby: a second data area, made in idle "
     "time"},
    {"--allow-overrun", nullptr, "switch even if a task may be delayed"},
    {"--restricted", nullptr, "refuse when the interface of a POU is edited"},
    {"--unrestricted", nullptr, "do not, whatever the project says"},
    {"--permanent", nullptr, "accept at once: no undo, the new program boots next"},
    STVM_DIALECT_OPTION,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kCommand{"change", "SOURCES...|IMAGE",
                                  "Changes the running program without stopping it.", kOptions, 1};

base::Result<base::Bytes> make_package(const tools::Options& options, bool restricted,
                                       base::ByteSpan running) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  std::string base_file = folder->file("running.img");
  std::string package_file = folder->file("change.pkg");
  base::Status written = tools::write_file(base_file, running);
  if (!written.ok()) return written.error();
  std::vector<std::string> command = {"package", "--base", base_file, "-o", package_file};
  if (restricted) command.push_back("--restricted");
  base::Status made = tools::run_beside("stc", stc_arguments(command, sources_of(options)));
  if (!made.ok()) return made.error();
  return tools::read_bytes(package_file);
}

std::string losses_text(const FatePage& page) {
  if (page.loss_count == 0) return {};
  std::string out = "\n" + std::to_string(page.loss_count) + " live value(s) would be lost:\n";
  tools::Table table({"variable", "now", "after", "what"});
  for (const LossLine& line : page.losses) {
    table.row({line.loss.path, line.loss.old_value, line.loss.new_value, line.loss.what});
  }
  return out + table.text();
}

void losses_json(const FatePage& page, tools::JsonWriter& json) {
  json.field("loss_count", page.loss_count).key("losses").begin_array();
  for (const LossLine& line : page.losses) {
    json.begin_object().field("variable", line.loss.path).field("live", line.loss.old_value);
    json.field("after", line.loss.new_value).field("what", line.loss.what).end_object();
  }
  json.end_array();
}

base::Status ask() {
  if (::isatty(STDIN_FILENO) == 0) {
    return base::Error{base::Refusal::kUsage, "nobody to ask: not a terminal; give --yes"};
  }
  std::fputs("Switch now? [y/N] ", stderr);
  std::string answer;
  std::getline(std::cin, answer);
  if (answer == "y" || answer == "Y" || answer == "yes") return base::Ok{};
  return base::Error{base::Refusal::kBusy, "not switched; the old program runs on"};
}

uint32_t switch_flags(const tools::Options& options) {
  return (options.has("--allow-loss") ? vm::kAllowLoss : 0u) |
         (options.has("--allow-overrun") ? vm::kAllowOverrun : 0u) |
         (options.has("--permanent") ? vm::kPermanent : 0u);
}

// What stands between the report and the switch.
base::Status may_switch(const tools::Options& options, const FatePage& page) {
  if (page.loss_count != 0 && !options.has("--allow-loss")) {
    return base::Error{base::Refusal::kWouldLose,
                       std::to_string(page.loss_count) + " live value(s) would be lost"};
  }
  return options.has("--yes") ? base::Status(base::Ok{}) : ask();
}

// Variables that the staged version would no longer exchange with other resources.
base::Result<std::vector<std::string>> exchange_notes(ControllerClient& client) {
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  std::vector<std::string> notes;
  for (vm::DeviceStatus& row : status->devices) {
    if (row.state == vm::kStagedState) notes.push_back(std::move(row.error));
  }
  return notes;
}

struct Outcome {
  FatePage page;
  std::vector<std::string> exchange;
  std::optional<online_change::SwitchReport> report;
  std::optional<base::Error> refused;  // after the report was made
};

void print_text(const Outcome& outcome, bool permanent) {
  if (!outcome.report) return;
  std::fputs(switch_text("switched", *outcome.report).c_str(), stdout);
  std::printf("%s\n", permanent
                          ? "accepted: it boots next"
                          : "on trial: `stvm accept` makes it final, `stvm undo` takes it back");
}

void print_json(const Outcome& outcome) {
  tools::JsonWriter json;
  json.begin_object();
  fates_json(outcome.page, json);
  losses_json(outcome.page, json);
  json.key("exchange").begin_array();
  for (const std::string& note : outcome.exchange) json.value(note);
  json.end_array();
  json.field("switched", outcome.report.has_value());
  if (outcome.report) switch_json(*outcome.report, json);
  if (outcome.refused) json.field("refused", base::refusal_code(outcome.refused->refusal));
  json.end_object();
  std::fputs(json.finish().c_str(), stdout);
}

// Of stc.toml, where the command line says nothing else.
base::Result<tools::ChangeSettings> settings_of(const tools::Options& options) {
  base::Result<tools::ChangeSettings> settings = tools::change_settings(options.arguments());
  if (!settings.ok()) return settings;
  if (options.has("--restricted") && options.has("--unrestricted")) {
    return base::Error{base::Refusal::kUsage, "--restricted and --unrestricted: which?"};
  }
  settings->strategy = options.text("--strategy", settings->strategy);
  if (options.has("--restricted")) settings->restricted = true;
  if (options.has("--unrestricted")) settings->restricted = false;
  return settings;
}

base::Result<uint32_t> stage_flags(const std::string& strategy) {
  if (strategy.empty() || strategy == "in-place") return 0u;
  if (strategy == "standby") return uint32_t{vm::kByStandby};
  return base::Error{base::Refusal::kUsage,
                     "--strategy is in-place or standby, not `" + strategy + "`"};
}

base::Result<Outcome> change(const tools::Options& options, ControllerClient& client, bool json) {
  base::Result<tools::ChangeSettings> settings = settings_of(options);
  if (!settings.ok()) return settings.error();
  base::Result<uint32_t> strategy = stage_flags(settings->strategy);
  if (!strategy.ok()) return strategy.error();
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  if (status->change == "trial") {
    return base::Error{base::Refusal::kChangePending,
                       "the last change is still on trial; `stvm accept` or `stvm undo` ends that"};
  }
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return running.error();
  base::Result<base::Bytes> package = make_package(options, settings->restricted, *running);
  if (!package.ok()) return package.error();
  base::Status staged = client.stage(*package, *strategy);
  if (!staged.ok()) return staged.error();
  base::Result<FatePage> page = client.fates();
  if (!page.ok()) return page.error();
  base::Result<std::vector<std::string>> notes = exchange_notes(client);
  if (!notes.ok()) return notes.error();
  Outcome outcome{std::move(*page), std::move(*notes), {}, {}};
  if (!json) {
    std::string report = fates_text(outcome.page);
    std::fputs((report + losses_text(outcome.page)).c_str(), stdout);
    for (const std::string& note : outcome.exchange) std::printf("exchange: %s\n", note.c_str());
    std::fflush(stdout);
  }
  base::Status go = base::Ok{};
  if (!options.has("--dry-run")) go = may_switch(options, outcome.page);
  if (options.has("--dry-run") || !go.ok()) {
    base::Result<base::Bytes> cancelled = client.call({.command = vm::Command::kCancel});
    if (!cancelled.ok()) return cancelled.error();
    if (!go.ok()) outcome.refused = go.error();
    return outcome;
  }
  base::Result<online_change::SwitchReport> report = client.make_switch(switch_flags(options));
  if (report.ok()) {
    outcome.report = *report;
  } else {
    outcome.refused = report.error();
    (void)client.call({.command = vm::Command::kCancel}).ok();
  }
  return outcome;
}

int run(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return refuse(json.error());
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return refuse(client.error());
  base::Result<Outcome> outcome = change(options, *client, *json);
  if (!outcome.ok()) return refuse(outcome.error());
  if (*json) {
    print_json(*outcome);
  } else {
    print_text(*outcome, options.has("--permanent"));
  }
  return outcome->refused ? refuse(*outcome->refused) : tools::kOk;
}

}  // namespace

const Entry kChange{&kCommand, run};

}  // namespace stvm
