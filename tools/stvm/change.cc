// stvm change: a new program for a running controller. Fetch what runs, let stc make the package,
// show every variable's fate, ask, switch.
#include <cstdio>

#include "online_change/package/package.h"
#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"
#include "tools/stvm/change_follow.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/first_scans.h"
#include "tools/stvm/fleet_edit.h"
#include "tools/stvm/package_making.h"
#include "tools/stvm/switch_option_rows.h"
#include "tools/stvm/switch_steps.h"
#include "tools/stvm/waiting.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kChangeOptions[] = {
    STVM_CONTROLLER_OPTIONS,
    STVM_SWITCH_OPTIONS,
    tools::kMatchingOption,
    {"--watch", nullptr, "stay, and bring each save of the sources to the controller"},
    TOOLS_COMPILE_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::OptionRow kRevertOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_SWITCH_OPTIONS,
                                               STVM_FORMAT_OPTION};
constexpr tools::Command kRevertCommand{
    "revert",       "", "Changes to the program that ran before the last accepted change.",
    kRevertOptions, 0,  0};
constexpr tools::Command kChangeCommand{"change", "SOURCES...|IMAGE|PACKAGE|FLEET-FILE",
                                        "Changes the running program without stopping it.",
                                        kChangeOptions, 1};

// Made apart, and signed or not.
bool is_package(const std::string& path) {
  if (tools::is_signed_as(path, online_change::SignedKind::kPackage)) return true;
  if (!tools::is_file(path)) return false;
  base::Result<base::Bytes> first = tools::read_first(path, online_change::kPackageMagicBytes);
  return first.ok() && online_change::has_package_magic(*first);
}

base::Result<base::Bytes> package_of(const tools::Options& options, bool restricted,
                                     ControllerClient& client) {
  const std::vector<std::string>& paths = options.arguments();
  if (paths.size() == 1 && is_package(paths[0])) return tools::read_bytes(paths[0]);
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return running.error();
  return make_package(sources_of(options), {restricted, options.has("--matching")}, *running);
}

// The version before is changed to like any other: what it does not have is lost, what it alone
// has begins anew.
base::Result<base::Bytes> package_back(const tools::Options&, bool restricted,
                                       ControllerClient& client) {
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return running.error();
  base::Result<base::Bytes> before = client.image_before();
  if (!before.ok()) return before.error();
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("before.img");
  base::Status written = tools::write_file(file, *before);
  if (!written.ok()) return written.error();
  return make_package({{file}, {}}, {restricted, false}, *running);
}

// Whoever undoes those takes this one back before.
void say_below(const vm::StatusReport& status) {
  const std::string by = status.changed_by.empty() ? "" : ", the newest by " + status.changed_by;
  std::printf("%llu edit(s) on trial%s: this one is made on top (stvm edits)\n",
              static_cast<unsigned long long>(status.edits), by.c_str());
}

using MakePackage = base::Result<base::Bytes> (*)(const tools::Options&, bool, ControllerClient&);

base::Result<Outcome> change(const tools::Options& options, const SwitchOptions& how,
                             ControllerClient& client, MakePackage make) {
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  const bool waits = how.wait && !how.dry_run;
  base::Status free = waits ? check_no_trial(*status) : base::Status(base::Ok{});
  if (!free.ok()) return free.error();
  if (status->edits != 0 && !how.json) say_below(*status);
  base::Result<base::Bytes> package = make(options, how.restricted, client);
  if (!package.ok()) return package.error();
  return bring(how, client, *package);
}

base::Result<Outcome> change_behind_others(const tools::Options& options, const SwitchOptions& how,
                                           ControllerClient& client, MakePackage make) {
  for (bool said = false;;) {
    if (base::Status waited = wait_for_others(client); !waited.ok()) return waited.error();
    base::Result<Outcome> outcome = change(options, how, client, make);
    const base::Error* const error = why_not(outcome);
    if (error == nullptr || !others_change(*error)) return outcome;
    if (!said) std::fprintf(stderr, "waiting: %s\n", error->text.c_str());
    said = true;
  }
}

int finish(const tools::Options& options, const SwitchOptions& how, ControllerClient& client,
           MakePackage make) {
  base::Result<Outcome> outcome = how.wait && !how.dry_run
                                      ? change_behind_others(options, how, client, make)
                                      : change(options, how, client, make);
  if (!outcome.ok()) return refuse(outcome.error());
  const bool watched = (how.switch_flags & vm::kNoWayBack) == 0 && !outcome->permanent;
  if (outcome->report && watched) {
    base::Status stays = first_scans(client);
    if (!stays.ok()) outcome->refused = stays.error();
  }
  print(how, *outcome);
  return outcome->refused ? refuse_reported(*outcome->refused) : tools::kOk;
}

int run_change(const tools::Options& options) {
  base::Result<SwitchOptions> how = switch_options(options);
  if (!how.ok()) return refuse(how.error());
  base::Status fit = check_compile_options(sources_of(options));
  if (!fit.ok()) return refuse(fit.error());
  how->note = fleet_note_of(options.arguments()[0]);
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return refuse(client.error());
  if (options.has("--watch")) return follow(sources_of(options), *how, *client);
  return finish(options, *how, *client, package_of);
}

int revert(const tools::Options& options) {
  base::Result<SwitchOptions> how = switch_options(options);
  if (!how.ok()) return refuse(how.error());
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return refuse(client.error());
  return finish(options, *how, *client, package_back);
}

}  // namespace

const Entry kChange{&kChangeCommand, run_change};
const Entry kRevert{&kRevertCommand, revert};

}  // namespace stvm
