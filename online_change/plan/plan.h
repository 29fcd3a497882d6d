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

namespace online_change {

inline constexpr uint32_t kNoFate = 0xffffffffu;  // UpdateStep::fate: no variable, an instance slot

// Update record (A3, A13). Offsets are in data memory. A step stands for `count` values:
// from + i * from_stride -> to + i * to_stride, `size` bytes each.
enum class StepKind : uint8_t {
  kInitialise,  // bytes -> to
  kCopy,        // size bytes: from -> to
  kConvert,     // one scalar or string value by A14
  kEnter,       // a step of a chart: as kCopy, or from `from_stride` where the step there is active
  kMigrate,     // what a migration gives: `from` is the number of its call, `from_stride` the place
                // in the function's frame; `bytes` are made on the controller
  kGather,      // bytes and bits that stay at their %M or %Q address: `from` is the number of its
                // row in Plan::gathers, `bytes` is what no row gives
};

struct UpdateStep {
  StepKind kind = StepKind::kCopy;
  uint32_t from = 0;
  uint32_t to = 0;
  uint32_t size = 0;  // of one value in the new version
  uint32_t count = 1;
  uint32_t from_stride = 0;
  uint32_t to_stride = 0;
  ir::TypeId old_type;      // kConvert, in the old image
  ir::TypeId new_type;      // kConvert, in the new image
  uint32_t fate = kNoFate;  // row of Plan::fates
  bool early =
      false;  // kInitialise into bytes that version 1 does not own: done while it runs (A19)
  // kInitialise, of all values; empty: zeros. kConvert, on the controller: what an edit that is
  // taken out has made of which values, and these (apply/live_value.h); in packages empty.
  base::Bytes bytes;
  uint64_t total() const { return uint64_t{size} * count; }
};

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
