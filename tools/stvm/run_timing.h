// What `stvm run` takes for the time of scans and of a change in virtual time (B11).
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "online_change/apply/change.h"
#include "tools/stvm/compiler.h"
#include "tools/stvm/timing_chart.h"
#include "vm/runtime/clocks.h"

#define STVM_TIMING_OPTIONS                                                                    \
  {"--duration", "TASK=TIME", "virtual time: each scan of the task lasts so long; repeatable", \
   "",           "",          tools::Times::kMany},                                            \
      {"--safe-point", "TIME", "virtual time: so much for each call and end of a loop"},       \
      {"--change", "TIME=PATH", "virtual time: change to that program at this time"},          \
      {"--configuration", "TIME", "idle time that this change takes before its switch"},       \
      tools::kStrategyOption, {                                                                \
    "--chart", "FILE|-", "SVG timing chart of tasks, exchange and change; -: as text"          \
  }

namespace stvm {

// The change of --change: staged at its time, configured in idle time only (C5), switched at the
// first boundary at which its pause fits before the next cycle, and accepted.
class RunChange {
 public:
  struct Settings {
    int64_t at_ns = 0;
    Sources sources;
    int64_t lasts_ns = 0;  // the configuration, at least
    online_change::Strategy strategy = online_change::Strategy::kInPlace;
  };
  RunChange(Settings settings, vm::Controller& controller, vm::VirtualClock& clock)
      : settings_(std::move(settings)),
        controller_(controller),
        clock_(clock),
        change_(controller) {}

  // At each boundary; `chart` can be null.
  base::Status step(TimingChart* chart);
  // kUsage when the run was too short for it.
  base::Status end() const;

 private:
  base::Status stage();
  base::Status configure();
  base::Status switch_over();

  Settings settings_;
  vm::Controller& controller_;
  vm::VirtualClock& clock_;
  online_change::Change change_;
  int64_t spent_ns_ = 0;
  bool staged_ = false;
  bool configured_ = false;
  bool done_ = false;
};

struct RunTiming {
  std::vector<std::pair<std::string, int64_t>> durations;  // task and ns
  int64_t safe_point_ns = 0;
  std::optional<RunChange::Settings> change;
  std::string chart;  // a file, "-", or "": none

  // kUsage for what is no time, for one that needs --virtual-time, and with --record: a recording
  // knows nothing of such times.
  static base::Result<RunTiming> read(const tools::Options& options);
  // Is there anything that says how long something lasts?
  bool any() const { return !durations.empty() || safe_point_ns != 0 || change.has_value(); }
  // kNoSuchTask.
  base::Status check_tasks(const ir::Image& image) const;
  // Safe points between two looks at the clock, so that suspension is exact to 10 us.
  uint64_t fuel_slice(uint64_t usual) const;
};

}  // namespace stvm
