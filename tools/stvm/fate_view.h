// The fate report of a controller as people and scripts read it: of a change, and of its undo (X4).
#pragma once

#include <string>

#include "tools/common/json.h"
#include "tools/stvm/fate_message.h"

namespace stvm {

std::string fates_text(const FatePage& page);
// Into an open object.
void fates_json(const FatePage& page, tools::JsonWriter& json);
// What would be lost. `more_by`: how the rest is shown, " (--all shows each)".
std::string losses_text(const FatePage& page, const char* more_by);
void losses_json(const FatePage& page, tools::JsonWriter& json);
// kWouldLose, unless that is allowed.
base::Status check_losses(const FatePage& page, bool allowed);

}  // namespace stvm
