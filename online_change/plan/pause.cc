#include "online_change/plan/pause.h"

#include "ir/bytecode/bools.h"
#include "online_change/diff/fast_conversion.h"
#include "online_change/diff/place_moves.h"
#include "online_change/diff/reference_leaves.h"

namespace online_change {

int64_t pause_ns(const BoundaryWork& work) {
  const auto times = [](uint64_t count, int64_t ns) { return static_cast<int64_t>(count) * ns; };
  const auto at = [](uint64_t count, int64_t per_ns) {
    return static_cast<int64_t>(count) / per_ns;
  };
  return kPauseFixedNs + times(work.steps, kPauseStepNs) + times(work.jumps, kPauseJumpNs) +
         at(work.values, kPauseValuesPerNs) + times(work.slow_values, kPauseSlowConversionNs) +
         at(work.bytes, kPauseBytesPerNs) + times(work.calls, kPauseMigrationNs) +
         times(work.loops, kPauseLoopNs) + times(work.references, kPauseReferenceNs) +
         at(work.compared, kPauseComparedBytesPerNs) + at(work.copied, kPauseCopiedBytesPerNs);
}

// Forwards within two cache lines, the hardware fetches ahead.
void BoundaryWork::step(uint32_t from, uint32_t to) {
  constexpr uint32_t kNear = 128;
  ++steps;
  if (from - from_ >= kNear || to - to_ >= kNear) ++jumps;
  from_ = from;
  to_ = to;
}

bool converts_slowly(const UpdateStep& step, const ir::Image& old_image,
                     const ir::Image& new_image) {
  const auto* converted = step.as<ConvertedValues>();
  if (converted == nullptr) return false;
  return !converted->known.empty() ||
         fast_converter(old_image.types, converted->old_type, new_image.types,
                        converted->new_type) == nullptr;
}

uint64_t bools_to_normalise(const ir::Bools& before, const ir::Bools& after) {
  return ir::needs_normalising(before, after) ? after.count() : 0;
}

BoundaryWork boundary_work(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
                           bool early_too) {
  BoundaryWork work;
  for (const UpdateStep& step : plan.steps) {
    if (step.early() && !early_too) continue;
    work.step(step.source().value_or(CopiedValues{}).from, step.to);
    (converts_slowly(step, old_image, new_image) ? work.slow_values : work.values) += step.count;
    work.bytes += step.total();
  }
  work.calls = plan.calls.size();
  work.values += bools_to_normalise(ir::Bools(old_image), ir::Bools(new_image));
  if (!PlaceMoves(old_image, new_image).trivial()) {
    work.references = reference_leaves(new_image).size();
  }
  return work;
}

int64_t predicted_pause_ns(const Plan& plan, const ir::Image& old_image,
                           const ir::Image& new_image) {
  return pause_ns(boundary_work(plan, old_image, new_image, false));
}

}  // namespace online_change
