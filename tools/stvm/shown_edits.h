// ShownEdits: what a change edits, as much as fits into one message. `stc diff` shows all of it.
#pragma once

#include "ir/bytecode/verify.h"
#include "tools/common/fate_report.h"
#include "vm/runtime/controller.h"

namespace stvm {

tools::PouEdits shown_edits(const ir::VerifiedImage& old_image, const ir::VerifiedImage& new_image);
// Forces first. The last row says how many are left out. `next_forces`: Change::next_forces().
tools::SystemEdits shown_system(const vm::Controller& controller,
                                const ir::VerifiedImage& new_image,
                                const vm::ForcedSet& next_forces);

}  // namespace stvm
