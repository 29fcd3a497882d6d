// The fate report of a controller as people and scripts read it: of a change, and of its undo (X4).
#pragma once

#include <string>

#include "tools/common/json.h"
#include "tools/stvm/fate_message.h"

namespace stvm {

std::string fates_text(const FatePage& page);
// Into an open object.
void fates_json(const FatePage& page, tools::JsonWriter& json);

}  // namespace stvm
