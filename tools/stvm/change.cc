// stvm change: a new program for a running controller. Fetch what runs, let stc make the package,
// show every variable's fate, ask, switch.
#include "tools/common/child.h"
#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/stvm/change_follow.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/switch_steps.h"

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
    {"--watch", nullptr, "stay, and bring each save of the sources to the controller"},
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

base::Result<Outcome> change(const tools::Options& options, const SwitchOptions& how,
                             ControllerClient& client) {
  base::Result<vm::StatusReport> status = client.status();
  if (!status.ok()) return status.error();
  base::Status free = check_no_trial(*status);
  if (!free.ok()) return free.error();
  base::Result<base::Bytes> running = client.image();
  if (!running.ok()) return running.error();
  base::Result<base::Bytes> package = make_package(options, how.restricted, *running);
  if (!package.ok()) return package.error();
  return bring(how, client, *package);
}

int run(const tools::Options& options) {
  base::Result<SwitchOptions> how = switch_options(options);
  if (!how.ok()) return refuse(how.error());
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return refuse(client.error());
  if (options.has("--watch")) return follow(sources_of(options), *how, *client);
  base::Result<Outcome> outcome = change(options, *how, *client);
  if (!outcome.ok()) return refuse(outcome.error());
  print(*how, *outcome);
  return outcome->refused ? refuse(*outcome->refused) : tools::kOk;
}

}  // namespace

const Entry kChange{&kCommand, run};

}  // namespace stvm
