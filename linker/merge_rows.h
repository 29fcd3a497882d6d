// The declarations of a merged program: types, globals, tasks, program instances and what else is
// no code (merge.h).
#pragma once

#include <memory>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/part_edits.h"
#include "linker/merge.h"
#include "linker/part_choice.h"
#include "linker/translate.h"
#include "linker/unlink.h"

namespace linker {

struct MergedRows {
  std::unique_ptr<ir::Program> merged;  // the translators refer to it
  std::unique_ptr<Translator> from_edited;
  std::unique_ptr<Translator> from_target;
  std::vector<ir::Device> devices;
  std::vector<ir::SafeOutput> safe;
};

// All parts in `choice` can be taken. The result borrows the images and what they were taken apart
// into.
base::Result<MergedRows> merge_rows(const MergeInput& input, const PartChoice& choice,
                                    const Unlinked& edited, const Unlinked& target);

}  // namespace linker
