// stvm watch: samples of variables, each of one boundary, until interrupted.
#include <chrono>
#include <cstdio>
#include <thread>

#include "tools/common/exit.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/names.h"
#include "tools/stvm/stop_signal.h"
#include "tools/stvm/values.h"

namespace stvm {
namespace {

constexpr tools::OptionRow kWatchOptions[] = {
    tools::kIntervalOption,
    tools::kCountOption,
    STVM_CONTROLLER_OPTIONS,
    STVM_FORMAT_OPTION,
};
constexpr tools::Command kWatchCommand{"watch", "NAMES...",
                                       "Shows values again and again, one line for each sample.",
                                       kWatchOptions, 1};

std::string sample_text(const vm::Values& values) {
  std::string out = std::to_string(values.cycle);
  if (values.last_cycle != values.cycle) out += ".." + std::to_string(values.last_cycle);
  out += ":";
  for (const vm::ValueRow& row : values.rows) out += " " + row.path + "=" + row.value;
  return out + "\n";
}

base::Status watch(const tools::Options& options) {
  const bool json = wants_json(options);
  base::Result<uint64_t> interval = options.number("--interval", 500);
  if (!interval.ok()) return interval.error();
  base::Result<uint64_t> count = options.number("--count", UINT64_MAX);
  if (!count.ok()) return count.error();
  base::Result<ControllerClient> client = ControllerClient::connect(options);
  if (!client.ok()) return client.error();
  base::Result<Names> names = matching(*client, options.arguments());
  if (!names.ok()) return names.error();
  StopSignal::install();
  for (uint64_t i = 0; i < *count && !StopSignal::received(); ++i) {
    if (i != 0) std::this_thread::sleep_for(std::chrono::milliseconds(*interval));
    base::Result<vm::Values> values = client->get(*names);
    if (!values.ok()) return values.error();
    std::fputs((json ? values_json(*values) : sample_text(*values)).c_str(), stdout);
    std::fflush(stdout);
  }
  return base::Ok{};
}

int run_watch(const tools::Options& options) {
  base::Status watched = watch(options);
  return watched.ok() ? tools::kOk : refuse(watched.error());
}

}  // namespace

const Entry kWatch{&kWatchCommand, run_watch};

}  // namespace stvm
