// stvm revoke: brings a signed list of revoked keys to a controller (F-03).
#include <cstdio>

#include "tools/common/exit.h"
#include "tools/common/files.h"
#include "tools/common/json.h"
#include "tools/common/signed_content.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kRevokeOptions[] = {tools::kFormatOption, STVM_CONTROLLER_OPTIONS};
constexpr tools::Command kRevokeCommand{
    "revoke",       "FILE", "Brings a list of revoked keys (`stc key revoke`) to a controller.",
    kRevokeOptions, 1,      1};

base::Status revoke(const tools::Options& options) {
  const std::string& path = options.arguments()[0];
  if (tools::is_file(path) && !tools::is_signed_as(path, online_change::SignedKind::kRevoked)) {
    return base::Error{base::Refusal::kBadFormat, path + " is no list that `stc key revoke` made"};
  }
  base::Result<base::Bytes> list = tools::read_bytes(path);
  if (!list.ok()) return list.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();
  if (!status.ok()) return status.error();
  base::Status brought = client->stage(*list, 0);
  if (!brought.ok()) return brought;
  if (options.text("--format") == "json") {
    tools::JsonWriter json;
    json.begin_object().field("kept", true).end_object();
    std::fputs(json.finish().c_str(), stdout);
  } else {
    std::printf("revoked: the controller keeps the list\n");
  }
  return base::Ok{};
}

int run_revoke(const tools::Options& options) {
  base::Status done = revoke(options);
  return done.ok() ? tools::kOk : refuse(done.error());
}

}  // namespace

const Entry kRevoke{&kRevokeCommand, run_revoke};

}  // namespace stvm
