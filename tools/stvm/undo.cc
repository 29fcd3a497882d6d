// stvm undo, accept, stop: one command, one answer.
#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/fate_view.h"
#include "tools/stvm/question.h"
#include "tools/stvm/state_folder.h"
#include "tools/stvm/switch_text.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::OptionRow kUndoOptions[] = {tools::kYesOption, tools::kDryRunOption,
                                             STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kUndoCommand{
    "undo",       "", "Brings back the program, and the values, from before the last change.",
    kUndoOptions, 0,  0};
constexpr tools::Command kAcceptCommand{
    "accept", "", "Makes the last change final; the new program boots next.", kOptions, 0, 0};
constexpr tools::Command kStopCommand{"stop", "", "Ends a serving controller.", kOptions, 0, 0};

// Connects and learns which version runs.
base::Result<ControllerClient> meet(const tools::Options& options) {
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client;
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  return client;
}

base::Status undo_change(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = meet(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  if (status->change != "trial") {
    return base::Error{base::Refusal::kNothingToUndo, "there is no change in trial to undo"};
  }
  base::Result<FatePage> page = client->fates();
  if (!page.ok()) return page.error();
  const bool dry_run = options.has("--dry-run");
  if (!*json) std::fputs(fates_text(*page).c_str(), stdout);
  std::optional<online_change::SwitchReport> done;
  if (!dry_run) {
    // A script that takes a change back is not held up for want of a person.
    if (!options.has("--yes") && can_ask()) {
      std::fflush(stdout);
      base::Status go = ask("Take it back now?", "not undone; the program on trial runs on");
      if (!go.ok()) return go;
    }
    base::Result<online_change::SwitchReport> report = client->undo();
    if (!report.ok()) return report.error();
    done = *report;
    if (!*json) std::fputs(switch_text("undone", *done).c_str(), stdout);
  }
  if (!*json) return base::Ok{};
  tools::JsonWriter out;
  out.begin_object();
  fates_json(*page, out);
  out.field("undone", done.has_value());
  if (done) switch_json(*done, out);
  out.end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

base::Status simple(const tools::Options& options, vm::Command command, const char* done) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = meet(options);
  if (!client.ok()) return client.error();
  base::Result<base::Bytes> answer = client->call({.command = command});
  if (!answer.ok()) return answer.error();
  if (!*json) {
    std::printf("%s\n", done);
    return base::Ok{};
  }
  tools::JsonWriter out;
  out.begin_object().field(done, true).end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

int code_of(const base::Status& status) {
  return status.ok() ? tools::kOk : refuse(status.error());
}

int undo(const tools::Options& options) { return code_of(undo_change(options)); }
int accept(const tools::Options& options) {
  return code_of(simple(options, vm::Command::kAccept, "accepted"));
}
// The controller answers, ends its scan and goes; its folder is free when it has gone.
base::Status wait_until_gone(const std::string& directory) {
  constexpr auto kPatience = std::chrono::seconds(10);
  auto give_up = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    base::Result<StateFolder> folder = StateFolder::open(directory);
    if (folder.ok()) return base::Ok{};
    if (std::chrono::steady_clock::now() > give_up) return folder.error();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int stop(const tools::Options& options) {
  base::Status stopped = simple(options, vm::Command::kStop, "stopped");
  return code_of(stopped.ok() && !options.has("--host") ? wait_until_gone(state_directory(options))
                                                        : stopped);
}

}  // namespace

const Entry kUndo{&kUndoCommand, undo};
const Entry kAccept{&kAcceptCommand, accept};
const Entry kStop{&kStopCommand, stop};

}  // namespace stvm
