// plan(old image, new image) -> what is done to data memory, and every variable's
// fate. A pure function of the two images: their layouts are fixed (the linker laid the
// new one out against the old one), so undo has a plan as well.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "online_change/diff/address_bits.h"
#include "online_change/diff/fates.h"
#include "online_change/plan/update_step.h"

namespace online_change {

// A migration for one instance, or one value of a structure. Its code is the new version's, on the
// way back too.
struct MigrationInput {
  uint32_t from = 0;  // in data memory of the version that is read
  ir::TypeId type;    // there
  uint32_t slot = 0;  // place in the function's frame
};
struct MigrationCall {
  uint32_t row = 0;       // in Image::migrations
  uint32_t instance = 0;  // whose values are made, or in whose area the structure lies
  uint32_t place = 0;     // of the structure that is made; 0: it is for the whole instance
  ir::TypeId type;        // of the structure; invalid for an instance
  std::vector<MigrationInput> inputs;
};

struct Plan {
  std::vector<FateRow> fates;  // kept ones are counted, and listed only with something to say
  FateCounts counts;
  std::vector<UpdateStep> steps;  // no two boundary steps overlap in `to`
  std::vector<MigrationCall> calls;
  std::vector<Gather> gathers;
  uint64_t boundary_bytes = 0;  // bytes that the switch writes
  // Cost model of the pause: fixed + per step + per byte.
  int64_t predicted_pause_ns = 0;
};

// Both images must have passed verify(), or come from the linker. Refuses (kTooMany) a change of
// more pieces than a controller takes.
base::Result<Plan> plan(const ir::Image& old_image, const ir::Image& new_image);
// The way back from new to old. What it initialises or converts gets the value from before the
// change, unless version 2 wrote it (apply/transfer.h).
base::Result<Plan> inverse_plan(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
