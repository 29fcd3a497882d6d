// An update step as a package has it: the same fields for each kind of step, and then its bytes.
#pragma once

#include <optional>

#include "base/archive.h"
#include "online_change/plan/update_step.h"

namespace online_change {

struct StoredStep {
  StepKind kind = StepKind::kInitialise;
  bool early = false;
  uint32_t from = 0;  // kMigrate: call; kGather: row
  uint32_t to = 0;
  uint32_t size = 0;
  uint32_t count = 1;
  uint32_t from_stride = 0;  // kEnter: active; kMigrate: slot
  uint32_t to_stride = 0;
  ir::TypeId old_type;  // kConvert
  ir::TypeId new_type;  // kConvert, kMigrate
  uint32_t fate = kNoFate;
};

// Without its bytes, which are UpdateStep::bytes().
StoredStep stored(const UpdateStep& step);
// Nullopt: it comes early, or has bytes, and its kind has no place for that. Other fields that the
// kind has not are skipped.
std::optional<UpdateStep> from_stored(const StoredStep& stored, base::Bytes bytes);

void step_fields(base::WriteArchive& a, const UpdateStep& step);
void step_fields(base::ReadArchive& a, UpdateStep& step);

}  // namespace online_change
