#include "online_change/plan/pause.h"

namespace online_change {

int64_t predicted_pause_ns(const Plan& plan) {
  int64_t ns = kPauseFixedNs;
  for (const UpdateStep& step : plan.steps) {
    if (step.early) continue;
    int64_t per_value = step.kind == StepKind::kConvert ? kPauseConversionNs : kPauseValueNs;
    ns += kPauseStepNs + per_value * step.count;
    ns += static_cast<int64_t>(step.total()) / kPauseBytesPerNs;
  }
  return ns;
}

}  // namespace online_change
