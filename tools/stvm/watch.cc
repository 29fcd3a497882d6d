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

// A change may have taken some away.
base::Status forget_gone(ControllerClient& client, Names& names, const base::Error& why) {
  std::erase_if(names, [&](const std::string& name) {
    base::Result<vm::Values> value = client.get({name});
    const bool gone = !value.ok() && value.error().refusal == base::Refusal::kNoSuchVariable;
    if (gone) std::fprintf(stderr, "%s is not there any more\n", name.c_str());
    return gone;
  });
  return names.empty() ? base::Status(why) : base::Ok{};
}

// Who has seen samples gets further ones after what passes.
base::Status go_on(ControllerClient& client, Names& names, const base::Error& why) {
  if (why.refusal == base::Refusal::kNoSuchVariable) return forget_gone(client, names, why);
  if (why.refusal == base::Refusal::kStaleBase) return base::Ok{};  // a change in the middle
  if (why.refusal != base::Refusal::kBusy) return why;
  refuse(why);
  return base::Ok{};
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
  // Output that is lost is lost for good: a disk is full, or nobody reads.
  for (uint64_t shown = 0;
       shown < *count && !StopSignal::received() && std::ferror(stdout) == 0;) {
    if (shown != 0) std::this_thread::sleep_for(std::chrono::milliseconds(*interval));
    base::Result<vm::Values> values = client->get(*names);
    if (!values.ok()) {
      const base::Status goes_on =
          shown == 0 ? values.error() : go_on(*client, *names, values.error());
      if (!goes_on.ok()) return goes_on;
      continue;
    }
    ++shown;
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
