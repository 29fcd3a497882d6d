// stvm restart: all tasks run again, also after a fault.
#include <cstdio>

#include "base/visible_text.h"
#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kRestartOptions[] = {
    {"--warm", nullptr, "keeps what is RETAIN (default)", "", "--cold|--hot"},
    {"--cold", nullptr, "keeps nothing: all initial values", "", "--hot"},
    {"--hot", nullptr, "keeps all values: only goes on"},
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION};
constexpr tools::Command kRestartCommand{
    "restart", "", "Runs all tasks again, after a fault too.", kRestartOptions, 0, 0};

struct Kind {
  const char* option;
  const char* name;
  vm::Restart restart;
};
constexpr Kind kKinds[] = {{"--warm", "warm", vm::Restart::kWarm},
                           {"--cold", "cold", vm::Restart::kCold},
                           {"--hot", "hot", vm::Restart::kHot}};

Kind chosen(const tools::Options& options) {
  for (const Kind& kind : kKinds) {
    if (options.has(kind.option)) return kind;
  }
  return kKinds[0];
}

base::Status restart(const tools::Options& options) {
  const bool json = wants_json(options);
  const Kind kind = chosen(options);
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<vm::StatusReport> status = client->status();  // which version runs
  if (!status.ok()) return status.error();
  vm::Request request{.command = vm::Command::kRestart};
  request.flags = static_cast<uint32_t>(kind.restart);
  base::Result<base::Bytes> answer = client->call(request);
  if (!answer.ok()) return answer.error();
  const std::string left = base::visible(std::string(answer->begin(), answer->end()));
  if (!json) {
    std::printf("restarted, %s\n", kind.name);
    if (!left.empty()) std::printf("  not all instances left: %s\n", left.c_str());
    return base::Ok{};
  }
  tools::JsonWriter out;
  out.begin_object().field("restarted", kind.name).field("exit_error", left).end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

int run_restart(const tools::Options& options) {
  base::Status done = restart(options);
  return done.ok() ? tools::kOk : refuse(done.error());
}

}  // namespace

const Entry kRestart{&kRestartCommand, run_restart};

}  // namespace stvm
