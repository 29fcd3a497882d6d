// A switch or an undo as it was, for people and scripts.
#pragma once

#include <string>

#include "online_change/apply/change.h"
#include "tools/common/json.h"

namespace stvm {

// "switched between cycle 812 and 813: pause 12.5 us, 0 releases missed"
std::string switch_text(const char* verb, const online_change::SwitchReport& report);
void switch_json(const online_change::SwitchReport& report, tools::JsonWriter& json);

}  // namespace stvm
