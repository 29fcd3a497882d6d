// The cost model of the pause: what the boundary work of a plan is expected to take, and what work
// that has been done takes on a virtual clock.
// Constants from measurements on one core, two to four times what was measured there,
// so that the real pause stays below on a slower one.
#pragma once

#include <cstdint>

#include "ir/bytecode/bools.h"
#include "online_change/plan/plan.h"

namespace online_change {

inline constexpr int64_t kPauseFixedNs = 20'000;       // checks, publishing, cold caches
inline constexpr int64_t kPauseStepNs = 30;            // one step
inline constexpr int64_t kPauseValueNs = 6;            // one value copied, or converted fast
inline constexpr int64_t kPauseSlowConversionNs = 80;  // strings, enumerations, subranges
inline constexpr int64_t kPauseMigrationNs = 200;      // one call of a migration
inline constexpr int64_t kPauseLoopNs = 50;            // one loop or call in a migration
inline constexpr int64_t kPauseReferenceNs = 40;       // one reference, when targets move or go
inline constexpr int64_t kPauseBytesPerNs = 2;         // read, save and write together

// Standby: bytes that are looked at, and those of them that have changed and are copied.
inline constexpr int64_t kPauseComparedBytesPerNs = 4;
inline constexpr int64_t kPauseCopiedBytesPerNs = 4;

// Work at one boundary, counted.
struct BoundaryWork {
  uint64_t steps = 0;
  uint64_t values = 0;  // copied, or converted fast
  uint64_t slow_values = 0;
  uint64_t bytes = 0;  // of both
  uint64_t calls = 0;  // of migrations
  uint64_t loops = 0;  // in them
  uint64_t references = 0;
  uint64_t compared = 0;  // bytes
  uint64_t copied = 0;    // of those
};
int64_t pause_ns(const BoundaryWork& work);

// Is a value of this step converted by kPauseSlowConversionNs?
bool converts_slowly(const UpdateStep& step, const ir::Image& old_image,
                     const ir::Image& new_image);
// All that a plan asks for; `early_too`: also what can be done before the boundary. The loops of
// migrations are not known.
BoundaryWork boundary_work(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
                           bool early_too);
// Of BOOLs, when code that may write others into their bytes goes.
uint64_t bools_to_normalise(const ir::Bools& before, const ir::Bools& after);
// Of that, in place.
int64_t predicted_pause_ns(const Plan& plan, const ir::Image& old_image,
                           const ir::Image& new_image);

}  // namespace online_change
