#include "online_change/plan/pause.h"

#include "online_change/diff/fast_conversion.h"
#include "online_change/diff/place_moves.h"

namespace online_change {
namespace {

int64_t pause_of_steps(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
                       bool with_early) {
  int64_t ns = kPauseFixedNs;
  for (const UpdateStep& step : plan.steps) {
    if (step.early && !with_early) continue;
    bool slow =
        step.kind == StepKind::kConvert &&
        fast_converter(old_image.types, step.old_type, new_image.types, step.new_type) == nullptr;
    ns += kPauseStepNs + (slow ? kPauseSlowConversionNs : kPauseValueNs) * int64_t{step.count};
    ns += static_cast<int64_t>(step.total()) / kPauseBytesPerNs;
  }
  ns += kPauseMigrationNs * static_cast<int64_t>(plan.calls.size());
  if (!PlaceMoves(old_image, new_image).trivial()) {
    ns += kPauseReferenceNs * static_cast<int64_t>(reference_leaves(new_image).size());
  }
  return ns;
}

}  // namespace

int64_t predicted_pause_ns(const Plan& plan, const ir::Image& old_image,
                           const ir::Image& new_image) {
  return pause_of_steps(plan, old_image, new_image, false);
}

int64_t predicted_standby_pause_ns(const Plan& plan, const ir::Image& old_image,
                                   const ir::Image& new_image, uint64_t compared) {
  return pause_of_steps(plan, old_image, new_image, true) +
         static_cast<int64_t>(compared) / kPauseComparedBytesPerNs;
}

}  // namespace online_change
