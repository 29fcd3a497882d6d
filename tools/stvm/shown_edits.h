// Of what a change edits: as much as fits into one message. `stc diff` shows all of it.
#pragma once

#include "ir/bytecode/verify.h"
#include "tools/common/fate_report.h"

namespace stvm {

tools::PouEdits shown_edits(const ir::VerifiedImage& old_image, const ir::VerifiedImage& new_image);
// The last row says how many are left out.
tools::SystemEdits shown_system(const ir::VerifiedImage& old_image,
                                const ir::VerifiedImage& new_image);

}  // namespace stvm
