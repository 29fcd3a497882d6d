// stvm set, force, unforce: writing variables from outside.
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/names.h"
#include "tools/stvm/values.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kSetOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::OptionRow kUnforceOptions[] = {
    {"--all", nullptr, "every forced variable"}, STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kSetCommand{"set", "NAME=VALUE...",
                                     "Writes variables once, all at one boundary.", kSetOptions, 1};
constexpr tools::Command kForceCommand{"force", "NAME=VALUE...",
                                       "Imposes values on variables until they are released.",
                                       kSetOptions, 1};
constexpr tools::Command kUnforceCommand{"unforce", "NAMES...", "Releases forced variables.",
                                         kUnforceOptions};

// Connects and learns which version runs.
base::Result<ControllerClient> meet(const tools::Options& options) {
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client;
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  return client;
}

void print_done(vm::Command command, bool json) {
  if (!json) return;
  tools::JsonWriter out;
  out.begin_object().field(vm::command_name(command), true).end_object();
  std::fputs(out.finish().c_str(), stdout);
}

base::Status write(vm::Command command, const tools::Options& options) {
  base::Result<std::vector<Assignment>> rows = parse_assignments(options.arguments());
  if (!rows.ok()) return rows.error();
  const bool json = wants_json(options);
  base::Result<ControllerClient> client = meet(options);
  if (!client.ok()) return client.error();
  rows = matching(*client, *rows);
  if (!rows.ok()) return rows.error();
  Names names;
  std::vector<std::string> values;
  for (Assignment& row : *rows) {
    names.push_back(std::move(row.name));
    values.push_back(std::move(row.value));
  }
  if (command == vm::Command::kForce) {
    base::Result<vm::ForceRows> forces = client->force(names, values);
    if (!forces.ok()) return forces.error();
    std::fputs((json ? forces_json(*forces) : forces_text(*forces)).c_str(), stdout);
    return base::Ok{};
  }
  base::Status done = client->assign(command, names, values);
  if (done.ok()) print_done(command, json);
  return done;
}

base::Status release(const tools::Options& options) {
  if (options.arguments().empty() != options.has("--all")) {
    return base::Error{base::Refusal::kUsage, "unforce: needs NAMES, or --all"};
  }
  const bool json = wants_json(options);
  base::Result<ControllerClient> client = meet(options);
  if (!client.ok()) return client.error();
  base::Result<Names> names = matching_forces(*client, options.arguments());
  if (!names.ok()) return names.error();
  base::Status done = client->assign(vm::Command::kUnforce, *names, {});
  if (done.ok()) print_done(vm::Command::kUnforce, json);
  return done;
}

int code_of(const base::Status& status) {
  return status.ok() ? tools::kOk : refuse(status.error());
}

int set(const tools::Options& options) { return code_of(write(vm::Command::kSet, options)); }
int force(const tools::Options& options) { return code_of(write(vm::Command::kForce, options)); }
int unforce(const tools::Options& options) { return code_of(release(options)); }

}  // namespace

const Entry kSet{&kSetCommand, set};
const Entry kForce{&kForceCommand, force};
const Entry kUnforce{&kUnforceCommand, unforce};

}  // namespace stvm
