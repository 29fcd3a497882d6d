// Everything that a change does beside values and code (X1): what the two images say, outputs
// that code has left (vm/load/left_outputs.h), and which unit of an edit a POU is part of.
#pragma once

#include "ir/bytecode/verify.h"
#include "tools/common/fate_report.h"

namespace tools {

// What was renamed is what it was. `back`: the new image is the one that undo brings back.
SystemEdits all_system_edits(const ir::VerifiedImage& old_version,
                             const ir::VerifiedImage& new_version, bool back = false);

}  // namespace tools
