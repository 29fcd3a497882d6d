// The code of a merged program: which POUs come from the edit, which stay, and which of those that
// stay cannot (merge.h).
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "linker/merge.h"
#include "linker/merge_rows.h"
#include "linker/part_choice.h"
#include "linker/unlink.h"

namespace linker {

// POUs from one image whose code holds offsets of members, and those that hold sizes, as numbers
// (ir::Object::fixed): the first of each; "": none does.
struct FixedPous {
  std::string offsets;
  std::string sizes;
};

struct MergedPous {
  std::vector<ir::Object> objects;  // in the order of Program::pous
  FixedPous from_edited;
  FixedPous from_target;
};

// Fills the POUs, overrides and migrations of `rows.merged`. kCannotRelink: the text names each POU
// that cannot go with the edit, and why.
base::Result<MergedPous> merge_pous(const MergeInput& input, const PartChoice& choice,
                                    const Unlinked& edited, const Unlinked& target,
                                    MergedRows& rows);

}  // namespace linker
