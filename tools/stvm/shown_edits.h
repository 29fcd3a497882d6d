// ShownEdits: what a change edits, as much as fits into one message. `stc diff` shows all of it.
#pragma once

#include <span>
#include <string>

#include "ir/bytecode/verify.h"
#include "tools/common/fate_report.h"

namespace stvm {

tools::PouEdits shown_edits(const ir::VerifiedImage& old_image, const ir::VerifiedImage& new_image);
// The last row says how many are left out. `back`: by undo.
tools::SystemEdits shown_system(const ir::VerifiedImage& old_image,
                                const ir::VerifiedImage& new_image, bool back);

// "Main.pump, Main.tank and 3 more": of an image, by their numbers.
std::string instances_text(const ir::Image& image, std::span<const uint32_t> ids);

// Of an edit that was taken back, for the journal. `without`: instances whose FB_Exit did not run.
std::string undone_text(const std::string& edit, const std::string& without,
                        const std::string& why);

}  // namespace stvm
