// stvm undo, redo, accept: the edits on trial, one by one (D3).
#include <algorithm>
#include <cstdio>
#include <optional>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/first_scans.h"
#include "tools/stvm/question.h"
#include "tools/stvm/switch_steps.h"
#include "tools/stvm/switch_text.h"
#include "tools/stvm/undo_only.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kUndoOptions[] = {
    {"--only", nullptr, "take back this edit alone: those that were made later stay"},
    {"--allow-loss", nullptr, "undo even if live values are lost, as the report says"},
    {"--allow-overrun", nullptr, "with --only: even if a task may be delayed"},
    {"--sign", "KEY", "with --only: sign it for a controller with keys"},
    {"--skip-exit", nullptr, "do not run FB_Exit of what goes: one that traps keeps the edit"},
    tools::kYesOption,
    tools::kDryRunOption,
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION};
constexpr tools::Command kUndoCommand{
    "undo", "[EDIT...]",
    "Takes back the newest edit on trial, or these and all that were made on them.", kUndoOptions,
    0};
constexpr tools::OptionRow kRedoOptions[] = {
    tools::kYesOption,
    {"--allow-loss", nullptr, "switch even if live values are lost, as the report says"},
    {"--allow-overrun", nullptr, "switch even if a task may be delayed"},
    {"--no-auto-undo", nullptr, "do not undo it when a trap stops a task in its first cycles"},
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION};
constexpr tools::Command kRedoCommand{
    "redo", "[EDIT...]",
    "Brings the edit that was undone last again, or these and those below them.", kRedoOptions, 0};
constexpr tools::OptionRow kAcceptOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kAcceptCommand{
    "accept",
    "[EDIT]",
    "Makes all edits on trial final, or those up to this one; they boot next.",
    kAcceptOptions,
    0,
    1};

using Names = std::vector<std::string>;

// The edits in the order in which they go, up to the last one that is named; the first one when
// none is.
base::Result<Names> up_to(const Names& order, const Names& named, const char* what) {
  size_t count = named.empty() ? 1 : 0;
  for (const std::string& name : named) {
    const auto found = std::find(order.begin(), order.end(), name);
    if (found == order.end()) {
      return base::Error{base::Refusal::kNothingToUndo,
                         "no edit `" + name + "` " + what + "; `stvm edits` shows them"};
    }
    count = std::max(count, static_cast<size_t>(found - order.begin()) + 1);
  }
  return Names(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count));
}

struct Edits {
  Names on_trial;  // newest first
  Names undone;    // what comes again first
};

base::Result<Edits> edits_of(ControllerClient& client) {
  base::Result<std::vector<TrialEdit>> edits = client.edits();
  if (!edits.ok()) return edits.error();
  Edits out;
  for (const TrialEdit& edit : *edits) {
    (edit.undone ? out.undone : out.on_trial).push_back(edit.name);
  }
  std::reverse(out.on_trial.begin(), out.on_trial.end());
  return out;
}

std::string list_text(const Names& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

// Do some edits go that were not named? They were made on top of one that is.
bool more_go(const Names& going, const Names& named) {
  return going.size() > std::max<size_t>(named.size(), 1);
}

base::Status ask_about(const Names& going, const Names& named, bool may_ask) {
  if (!more_go(going, named)) return base::Ok{};
  std::fprintf(stderr, "these go, newest first: %s\n", list_text(going).c_str());
  return may_ask ? ask("Undo them now?", "nothing is undone") : base::Status(base::Ok{});
}

// Which were undone before one was refused stays undone.
base::Error behind(const Names& done, const base::Error& error) {
  if (done.empty()) return error;
  return {error.refusal, error.text + "; " + list_text(done) + " " +
                             (done.size() == 1 ? "is" : "are") + " undone"};
}

// What has been shown already is refused without being shown again.
struct Ended {
  base::Status status = base::Ok{};
  bool shown = false;
};

struct Undone {
  std::string edit;
  FatePage page;
  std::optional<online_change::SwitchReport> report;
};

// What the undo of each does, behind that of those before it.
base::Result<std::vector<Undone>> reports(ControllerClient& client, const Names& going,
                                          const std::string& way_back) {
  base::Result<vm::StatusReport> status = client.status();  // which version runs
  if (!status.ok()) return status.error();
  std::vector<Undone> all;
  for (const std::string& name : going) {
    base::Result<FatePage> page = client.fates(way_back, all.empty() ? "" : name);
    if (!page.ok()) return page.error();
    all.push_back({name, std::move(*page), std::nullopt});
  }
  return all;
}

void print_text(const std::vector<Undone>& all) {
  for (const Undone& undone : all) {
    if (all.size() != 1) std::printf("undo of %s\n", undone.edit.c_str());
    std::fputs((fates_text(undone.page) + losses_text(undone.page, "")).c_str(), stdout);
    if (all.size() != 1) std::puts("");
  }
  std::fflush(stdout);
}

base::Status check_losses(const std::vector<Undone>& all, bool allowed) {
  for (const Undone& undone : all) {
    base::Status whole = check_losses(undone.page, allowed);
    if (whole.ok()) continue;
    return base::Error{whole.error().refusal, "undo of " + undone.edit + ": " + whole.error().text +
                                                  ", which --allow-loss allows"};
  }
  return base::Ok{};
}

// One after the other, each at a boundary of its own.
base::Status carry_out(ControllerClient& client, std::vector<Undone>& all,
                       const std::vector<std::string>& ways, bool json) {
  Names done;
  for (Undone& undone : all) {
    if (!done.empty()) {
      base::Result<vm::StatusReport> status = client.status();
      if (!status.ok()) return behind(done, status.error());
    }
    base::Result<online_change::SwitchReport> report = client.undo(undone.edit, ways);
    if (!report.ok()) return behind(done, report.error());
    undone.report = *report;
    done.push_back(undone.edit);
    if (!json) std::fputs(switch_text((undone.edit + " undone").c_str(), *report).c_str(), stdout);
    std::fflush(stdout);
  }
  return first_scans_back(client, all.back().report->cycle_before);
}

void undone_json(const Undone& undone, tools::JsonWriter& out) {
  out.field("edit", undone.edit);
  fates_json(undone.page, out);
  losses_json(undone.page, out);
  out.field("undone", undone.report.has_value());
  if (undone.report) switch_json(*undone.report, out);
}

// One edit is an object, several are a list of them.
void print_json(const std::vector<Undone>& all, const Names& going, const base::Status& ended) {
  tools::JsonWriter out;
  out.begin_object();
  if (going.size() == 1) {
    for (const Undone& undone : all) undone_json(undone, out);
  } else {
    out.key("edits").begin_array();
    for (const Undone& undone : all) {
      out.begin_object();
      undone_json(undone, out);
      out.end_object();
    }
    out.end_array();
  }
  out.key("going").begin_array();
  for (const std::string& name : going) out.value(name);
  out.end_array();
  if (!ended.ok()) {
    out.field("refused", base::refusal_code(ended.error().refusal));
    out.field("message", ended.error().text);
  }
  out.end_object();
  std::fputs(out.finish().c_str(), stdout);
}

base::Status check_only(const tools::Options& options) {
  if (options.arguments().size() != 1) {
    return base::Error{base::Refusal::kUsage, "undo --only: name one edit"};
  }
  if (!options.has("--skip-exit")) return base::Ok{};
  return base::Error{base::Refusal::kUsage,
                     "undo --only is a change, whose FB_Exit runs; without --only the edits above "
                     "go too, and can be brought again"};
}

Ended undo_only(const tools::Options& options, ControllerClient& client, const Edits& edits) {
  if (base::Status fits = check_only(options); !fits.ok()) return {fits};
  SwitchOptions how;
  how.sign = options.text("--sign");
  how.dry_run = options.has("--dry-run");
  if (how.dry_run) how.stage_flags |= vm::kRehearsal;
  how.ask = !options.has("--yes");
  how.json = wants_json(options);
  how.switch_flags = (options.has("--allow-loss") ? vm::kAllowLoss : 0u) |
                     (options.has("--allow-overrun") ? vm::kAllowOverrun : 0u);
  base::Result<Outcome> outcome = take_out(how, client, options.arguments()[0], edits.on_trial);
  if (!outcome.ok()) return {outcome.error()};
  print(how, *outcome);
  return {outcome->refused ? base::Status(*outcome->refused) : base::Ok{}, true};
}

Ended undo_edits(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return {json.error()};
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return {client.error()};
  base::Result<Edits> edits = edits_of(*client);
  if (!edits.ok()) return {edits.error()};
  if (edits->on_trial.empty()) {
    return {base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to undo"}};
  }
  if (options.has("--only")) return undo_only(options, *client, *edits);
  const Names& named = options.arguments();
  base::Result<Names> going = up_to(edits->on_trial, named, "is on trial");
  if (!going.ok()) return {going.error()};
  const bool dry_run = options.has("--dry-run");
  const bool may_ask = !dry_run && !options.has("--yes");
  std::vector<std::string> ways;
  if (options.has("--skip-exit")) ways.push_back(vm::kWithoutExit);
  base::Result<std::vector<Undone>> all =
      reports(*client, *going, ways.empty() ? "" : ways.front());
  if (!all.ok()) return {all.error()};
  if (!*json) print_text(*all);
  const bool allow_loss = options.has("--allow-loss");
  const bool loses = !check_losses(*all, false).ok();
  base::Status ended = check_losses(*all, allow_loss);
  if (ended.ok()) ended = ask_about(*going, named, may_ask);
  // A script that takes a change back is not held up for want of a person.
  const bool ask_first = may_ask && can_ask() && !more_go(*going, named);
  if (ended.ok() && ask_first) {
    ended = ask("Take it back now?", "not undone; the program on trial runs on");
  }
  if (allow_loss && loses) ways.push_back(vm::kWithLoss);
  if (ended.ok() && !dry_run) ended = carry_out(*client, *all, ways, *json);
  if (*json) print_json(*all, *going, ended);
  return {ended, true};
}

SwitchOptions redo_options(const tools::Options& options, bool json) {
  SwitchOptions how;
  how.ask = !options.has("--yes");
  how.json = json;
  how.switch_flags = (options.has("--allow-loss") ? vm::kAllowLoss : 0u) |
                     (options.has("--allow-overrun") ? vm::kAllowOverrun : 0u) |
                     (options.has("--no-auto-undo") ? vm::kNoWayBack : 0u);
  return how;
}

Ended redo_edits(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return {json.error()};
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return {client.error()};
  base::Result<Edits> edits = edits_of(*client);
  if (!edits.ok()) return {edits.error()};
  if (edits->undone.empty()) {
    return {base::Error{base::Refusal::kNothingToUndo,
                        "no edit was undone that could be brought again"}};
  }
  base::Result<Names> coming = up_to(edits->undone, options.arguments(), "was undone");
  if (!coming.ok()) return {coming.error()};
  const SwitchOptions how = redo_options(options, *json);
  for (const std::string& name : *coming) {
    base::Result<vm::StatusReport> status = client->status();
    if (!status.ok()) return {status.error()};
    base::Status staged = client->stage_again(name);
    if (!staged.ok()) return {staged};
    if (!*json) std::printf("%s again\n", name.c_str());
    base::Result<Outcome> outcome = bring_staged(how, *client);
    if (!outcome.ok()) return {outcome.error()};
    if (outcome->report && (how.switch_flags & vm::kNoWayBack) == 0) {
      if (base::Status stays = first_scans(*client); !stays.ok()) outcome->refused = stays.error();
    }
    print(how, *outcome);
    if (outcome->refused) return {*outcome->refused, true};
  }
  return {};
}

base::Status accept_edits(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  vm::Request request{.command = vm::Command::kAccept, .names = options.arguments()};
  base::Result<base::Bytes> answer = client->call(std::move(request));
  if (!answer.ok()) return answer.error();
  if (!*json) {
    std::puts("accepted");
    return base::Ok{};
  }
  tools::JsonWriter out;
  out.begin_object().field("accepted", true).end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

int exit_code_of(const Ended& ended) {
  if (ended.status.ok()) return tools::kOk;
  return ended.shown ? refuse_reported(ended.status.error()) : refuse(ended.status.error());
}

int undo(const tools::Options& options) { return exit_code_of(undo_edits(options)); }
int redo(const tools::Options& options) { return exit_code_of(redo_edits(options)); }
int accept(const tools::Options& options) { return exit_code_of({accept_edits(options)}); }

}  // namespace

const Entry kUndo{&kUndoCommand, undo};
const Entry kRedo{&kRedoCommand, redo};
const Entry kAccept{&kAcceptCommand, accept};

}  // namespace stvm
