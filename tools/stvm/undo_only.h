// One edit of several on trial taken back alone (D3): what it made goes, and what was made on top
// of it stays.
#pragma once

#include <string>
#include <vector>

#include "tools/stvm/switch_steps.h"

namespace stvm {

// `on_trial`: newest first. A change on top of all of them, which is an edit of its own: undo of it
// brings the edit again. Variables that the edit had taken away have their values again (X4).
// kOtherPart, kCannotRelink where later edits depend on it.
base::Result<Outcome> take_out(const SwitchOptions& how, ControllerClient& client,
                               const std::string& edit, const std::vector<std::string>& on_trial);

// What the journal says of that change.
std::string take_out_note(const std::string& edit);

}  // namespace stvm
