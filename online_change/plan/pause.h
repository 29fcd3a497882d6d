// The cost model of the pause: what the boundary work of a plan is expected to take, and what work
// that has been done takes on a virtual clock. The constants are times of one machine, fitted to
// what `make bench-pause` measures there; another one is so many times slower (apply/pace.h). A
// prediction is within kReserve of what is measured (case 69), but for the first microseconds:
// how cold the caches are when a boundary comes nobody knows.
#pragma once

#include <cstdint>

#include "ir/bytecode/bools.h"
#include "online_change/plan/plan.h"

namespace online_change {

inline constexpr int64_t kPauseFixedNs = 2'000;        // checks, publishing, cold caches
inline constexpr int64_t kPauseStepNs = 10;            // one step
inline constexpr int64_t kPauseJumpNs = 17;            // to a place that no cache line has yet
inline constexpr int64_t kPauseValuesPerNs = 2;        // copied, or converted fast
inline constexpr int64_t kPauseSlowConversionNs = 11;  // strings, enumerations, subranges
inline constexpr int64_t kPauseMigrationNs = 200;      // one call of a migration
inline constexpr int64_t kPauseLoopNs = 50;            // one loop or call in a migration
inline constexpr int64_t kPauseReferenceNs = 20;       // one reference, when targets move or go
inline constexpr int64_t kPauseBytesPerNs = 32;        // read, save and write together

// Standby: bytes that are looked at, and those of them that have changed and are copied.
inline constexpr int64_t kPauseComparedBytesPerNs = 48;
inline constexpr int64_t kPauseCopiedBytesPerNs = 32;

// So much more than what is expected must be free before a switch begins.
constexpr int64_t with_reserve(int64_t pause_ns) { return pause_ns + pause_ns / 2; }

// Work at one boundary, counted.
struct BoundaryWork {
  uint64_t steps = 0;
  uint64_t jumps = 0;   // of them, to a place far from the one before
  uint64_t values = 0;  // copied, or converted fast
  uint64_t slow_values = 0;
  uint64_t bytes = 0;  // of both
  uint64_t calls = 0;  // of migrations
  uint64_t loops = 0;  // in them
  uint64_t references = 0;
  uint64_t compared = 0;  // bytes
  uint64_t copied = 0;    // of those
  // The next step; it reads at `from`, or nowhere (0), and writes at `to`.
  void step(uint32_t from, uint32_t to);

 private:
  uint32_t from_ = 0;  // of the step before
  uint32_t to_ = 0;
};
int64_t pause_ns(const BoundaryWork& work);

// Is a value of this step converted by kPauseSlowConversionNs?
bool converts_slowly(const UpdateStep& step, const ir::Image& old_image,
                     const ir::Image& new_image);
// All that a plan asks for; `early_too`: also what can be done before the boundary. The loops of
// migrations are not known.
BoundaryWork boundary_work(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image,
                           bool early_too);
// How many BOOLs need it, when code that may write others into their bytes goes.
uint64_t bools_to_normalise(const ir::Bools& before, const ir::Bools& after);
// The pause of that work, in place.
int64_t predicted_pause_ns(const Plan& plan, const ir::Image& old_image,
                           const ir::Image& new_image);

}  // namespace online_change
