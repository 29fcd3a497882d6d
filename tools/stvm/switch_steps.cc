#include "tools/stvm/switch_steps.h"

#include <algorithm>
#include <cstdio>
#include <thread>

#include "ir/bytecode/no_program.h"
#include "tools/common/change_settings.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/package_making.h"
#include "tools/stvm/question.h"
#include "tools/stvm/switch_text.h"
#include "vm/io/global_exchange.h"

namespace stvm {
namespace {

// What stands between the report and the switch.
base::Status may_switch(const SwitchOptions& options, const FatePage& page) {
  base::Status whole = check_losses(page, (options.switch_flags & vm::kAllowLoss) != 0);
  if (!whole.ok()) return whole;
  if (!options.ask || options.dry_run) return base::Ok{};
  if (options.confirm) return options.confirm();
  return ask("Switch now?", "not switched; the old program runs on");
}

// What the switch itself would refuse now (case 78).
base::Status rehearse(const SwitchOptions& options, ControllerClient& client) {
  vm::Request request{.command = vm::Command::kRehearse};
  request.flags = options.switch_flags;
  if (!options.health.empty()) request.names = {options.health};
  base::Result<base::Bytes> answer = client.call(std::move(request));
  return answer.ok() ? base::Status(base::Ok{}) : base::Status(answer.error());
}

// X6-03: the controller takes them, or nothing is switched.
base::Status guard_trial(const SwitchOptions& options, ControllerClient& client) {
  if (options.guard.empty()) return base::Ok{};
  vm::Request request{.command = vm::Command::kGuard};
  request.data = options.guard;
  base::Result<base::Bytes> answer = client.call(std::move(request));
  return answer.ok() ? base::Status(base::Ok{}) : base::Status(answer.error());
}

// Meanwhile the controller sees that somebody is there.
base::Status wait_for_window(const SwitchOptions& options, ControllerClient& client) {
  constexpr auto kBetween = std::chrono::milliseconds(500);
  const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(options.window_ms);
  for (;;) {
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= left.zero()) return base::Ok{};
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, kBetween));
    base::Result<vm::StatusReport> status = client.status();
    if (!status.ok()) return status.error();
  }
}

// Variables that the staged version would no longer exchange with other resources.
std::vector<std::string> exchange_notes(vm::StatusReport& status) {
  std::vector<std::string> notes;
  for (vm::DeviceStatus& row : status.devices) {
    if (row.state == vm::kStagedState) notes.push_back(std::move(row.error));
  }
  return notes;
}

void print_text(const Outcome& outcome) {
  if (!outcome.report) return;
  std::fputs(switch_text("switched", *outcome.report).c_str(), stdout);
  if (outcome.refused) return;  // the controller took it back
  std::printf("%s\n", outcome.permanent
                          ? "accepted: it boots next"
                          : "on trial: `stvm accept` makes it final, `stvm undo` takes it back");
}

void print_json(const Outcome& outcome, bool all) {
  tools::JsonWriter json;
  json.begin_object();
  fates_json(outcome.page, json);
  losses_json(outcome.page, json);
  if (all) tools::every_fate(outcome.every, json);
  json.key("exchange").begin_array();
  for (const std::string& note : outcome.exchange) json.value(note);
  json.end_array();
  json.field("switched", outcome.report.has_value());
  if (outcome.report) switch_json(*outcome.report, json);
  if (outcome.refused) {
    json.field("refused", base::refusal_code(outcome.refused->refusal));
    json.field("message", outcome.refused->text);
  }
  json.end_object();
  std::fputs(json.finish().c_str(), stdout);
}

// The settings of stc.toml, where the command line says nothing else.
base::Result<tools::ChangeSettings> settings_of(const tools::Options& options,
                                                const std::vector<std::string>& paths) {
  base::Result<tools::ChangeSettings> settings = tools::change_settings(paths);
  if (!settings.ok()) return settings;
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

uint32_t switch_flags(const tools::Options& options) {
  return (options.has("--allow-loss") ? vm::kAllowLoss : 0u) |
         (options.has("--allow-overrun") ? vm::kAllowOverrun : 0u) |
         (options.has("--no-auto-undo") ? vm::kNoWayBack : 0u) |
         (options.has("--permanent") ? vm::kPermanent : 0u);
}

}  // namespace

base::Result<SwitchOptions> switch_options(const tools::Options& options) {
  return switch_options(options, options.arguments());
}

base::Result<SwitchOptions> switch_options(const tools::Options& options,
                                           const std::vector<std::string>& paths) {
  SwitchOptions out;
  const bool json = wants_json(options);
  base::Result<tools::ChangeSettings> settings = settings_of(options, paths);
  if (!settings.ok()) return settings.error();
  base::Result<uint32_t> strategy = stage_flags(settings->strategy);
  if (!strategy.ok()) return strategy.error();
  out.stage_flags = *strategy | (settings->table_additions ? vm::kTableAdditions : 0u);
  out.switch_flags = switch_flags(options) | (settings->last_edit ? vm::kLastEditBoots : 0u);
  out.restricted = settings->restricted;
  out.health = options.text("--health", settings->health);
  out.unless = options.text("--unless", settings->unless);
  out.sign = options.text("--sign");
  out.dry_run = options.has("--dry-run");
  if (out.dry_run) out.stage_flags |= vm::kRehearsal;
  out.all = options.has("--all");
  out.wait = options.has("--wait");
  out.ask = !options.has("--yes");
  out.json = json;
  return out;
}

base::Status check_no_trial(const vm::StatusReport& status) {
  if (status.edits == 0) return base::Ok{};
  const std::string who = status.changed_by.empty() ? "" : ", by " + status.changed_by + ",";
  return base::Error{base::Refusal::kChangePending,
                     "the last change" + who +
                         " is still on trial; `stvm accept` or `stvm undo` ends that, and "
                         "--wait waits for it"};
}

base::Result<Outcome> bring(const SwitchOptions& options, ControllerClient& client,
                            base::ByteSpan package) {
  base::Bytes with_signature;
  if (!options.sign.empty()) {
    base::Result<base::Bytes> done = sign_package(package, options.sign);
    if (!done.ok()) return done.error();
    with_signature = std::move(*done);
    package = with_signature;
  }
  base::Status staged =
      client.stage(package, options.stage_flags, options.unless, options.note, options.taken_out);
  if (!staged.ok()) return staged.error();
  return bring_staged(options, client);
}

base::Result<Outcome> bring_staged(const SwitchOptions& options, ControllerClient& client) {
  const Outcome::Time prepared = std::chrono::steady_clock::now();
  base::Result<FatePage> page = client.fates();
  if (!page.ok()) return page.error();
  base::Result<vm::StatusReport> status = client.look();
  if (!status.ok()) return status.error();
  Outcome outcome{std::move(*page), {}, exchange_notes(*status), {}, {}, prepared, {}};
  const bool first = status->running == ir::no_program().digest();
  outcome.permanent = first || (options.switch_flags & vm::kPermanent) != 0;
  if (options.all) {
    base::Result<std::vector<FateLine>> every = client.every_fate();
    if (!every.ok()) return every.error();
    outcome.every = std::move(*every);
  }
  if (!options.json) {
    if (options.all) std::printf("%s\n", tools::every_fate_text(outcome.every).c_str());
    std::string report = fates_text(outcome.page);
    std::fputs((report + losses_text(outcome.page, " (--all shows each)")).c_str(), stdout);
    for (const std::string& note : outcome.exchange) std::printf("exchange: %s\n", note.c_str());
    std::fflush(stdout);
  }
  outcome.shown = std::chrono::steady_clock::now();
  base::Status go = may_switch(options, outcome.page);
  if (go.ok()) go = guard_trial(options, client);
  if (options.dry_run && go.ok()) go = rehearse(options, client);
  if (!options.dry_run && go.ok()) go = wait_for_window(options, client);
  if (options.dry_run || !go.ok()) {
    base::Result<base::Bytes> cancelled = client.call({.command = vm::Command::kCancel});
    if (!cancelled.ok()) return cancelled.error();
    if (!go.ok()) outcome.refused = go.error();
    return outcome;
  }
  auto report = client.make_switch(options.switch_flags, options.health);
  if (report.ok()) {
    outcome.report = *report;
  } else {
    outcome.refused = report.error();
    (void)client.call({.command = vm::Command::kCancel}).ok();
  }
  return outcome;
}

void print(const SwitchOptions& options, const Outcome& outcome) {
  if (options.json) {
    print_json(outcome, options.all);
  } else {
    print_text(outcome);
  }
  std::fflush(stdout);
}

}  // namespace stvm
