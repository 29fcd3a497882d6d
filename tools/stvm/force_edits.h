// Forces that a change moves, alters or ends: a row each in its report (X1, change case 64).
#pragma once

#include <vector>

#include "tools/common/fate_report.h"
#include "vm/runtime/forces.h"

namespace stvm {

// `now` is of `old_image`, `next` what becomes of it in `new_image` (Change::next_forces). A force
// that holds the same variable in the same way, at the same address, has no row. Undo brings back
// what ended by the change.
tools::SystemEdits force_edits(const ir::Image& old_image, const std::vector<vm::Force>& now,
                               const ir::Image& new_image, const vm::ForcedSet& next);

}  // namespace stvm
