// stvm stop: the controller answers, ends its scan and goes.
#include <chrono>
#include <cstdio>
#include <thread>

#include "tools/common/exit.h"
#include "tools/common/json.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/state_folder.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kStopOptions[] = {STVM_CONTROLLER_OPTIONS, STVM_FORMAT_OPTION};
constexpr tools::Command kStopCommand{"stop", "", "Ends a serving controller.", kStopOptions, 0, 0};

base::Status ask_to_stop(const tools::Options& options) {
  base::Result<bool> json = wants_json(options);
  if (!json.ok()) return json.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<base::Bytes> answer = client->call({.command = vm::Command::kStop});
  if (!answer.ok()) return answer.error();
  if (!*json) {
    std::puts("stopped");
    return base::Ok{};
  }
  tools::JsonWriter out;
  out.begin_object().field("stopped", true).end_object();
  std::fputs(out.finish().c_str(), stdout);
  return base::Ok{};
}

// The controller's folder is free when it has gone.
base::Status wait_until_gone(const std::string& directory) {
  constexpr auto kPatience = std::chrono::seconds(10);
  auto give_up = std::chrono::steady_clock::now() + kPatience;
  for (;;) {
    base::Result<StateFolder> folder = StateFolder::open(directory, false);
    if (folder.ok()) return base::Ok{};
    if (std::chrono::steady_clock::now() > give_up) return folder.error();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

int stop(const tools::Options& options) {
  base::Status stopped = ask_to_stop(options);
  if (stopped.ok() && !options.has("--host")) {
    stopped = wait_until_gone(state_directory(options));
  }
  return stopped.ok() ? tools::kOk : refuse(stopped.error());
}

}  // namespace

const Entry kStop{&kStopCommand, stop};

}  // namespace stvm
