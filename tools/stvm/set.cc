// stvm set, force, unforce: writing variables from outside.
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/trace.h"
#include "tools/stvm/values.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::OptionRow kUnforceOptions[] = {
    {"--all", nullptr, "every forced variable"}, STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kSetCommand{"set", "NAME=VALUE...",
                                     "Writes variables once, all at one boundary.", kOptions, 1};
constexpr tools::Command kForceCommand{
    "force", "NAME=VALUE...", "Imposes values on variables until they are released.", kOptions, 1};
constexpr tools::Command kUnforceCommand{"unforce", "NAMES...", "Releases forced variables.",
                                         kUnforceOptions};

base::Status send(vm::Command command, const tools::Options& options,
                  const std::vector<std::string>& names, const std::vector<std::string>& values) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  if (command == vm::Command::kForce) {
    base::Result<vm::ForceRows> forces = client->force(names, values);
    if (!forces.ok()) return forces.error();
    std::fputs((*json ? forces_json(*forces) : forces_text(*forces)).c_str(), stdout);
    return base::Ok{};
  }
  base::Status done = client->assign(command, names, values);
  if (!done.ok()) return done;
  if (*json) {
    tools::JsonWriter out;
    out.begin_object().field(vm::command_name(command), true).end_object();
    std::fputs(out.finish().c_str(), stdout);
  }
  return base::Ok{};
}

int assign(vm::Command command, const tools::Options& options) {
  base::Result<std::vector<Assignment>> rows = parse_assignments(options.arguments());
  if (!rows.ok()) return refuse(rows.error());
  std::vector<std::string> names;
  std::vector<std::string> values;
  for (Assignment& row : *rows) {
    names.push_back(std::move(row.name));
    values.push_back(std::move(row.value));
  }
  base::Status done = send(command, options, names, values);
  return done.ok() ? tools::kOk : refuse(done.error());
}

int set(const tools::Options& options) { return assign(vm::Command::kSet, options); }
int force(const tools::Options& options) { return assign(vm::Command::kForce, options); }

int unforce(const tools::Options& options) {
  if (options.arguments().empty() != options.has("--all")) {
    return refuse({base::Refusal::kUsage, "unforce: needs NAMES, or --all"});
  }
  base::Status done = send(vm::Command::kUnforce, options, options.arguments(), {});
  return done.ok() ? tools::kOk : refuse(done.error());
}

}  // namespace

const Entry kSet{&kSetCommand, set};
const Entry kForce{&kForceCommand, force};
const Entry kUnforce{&kUnforceCommand, unforce};

}  // namespace stvm
