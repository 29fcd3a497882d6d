// What tasks are doing and how their buffers stand (`stvm status --activity`), as text and JSON.
#pragma once

#include <string>
#include <vector>

#include "tools/common/json.h"
#include "vm/runtime/controller.h"

namespace stvm {

std::string activity_text(const std::vector<vm::TaskStatus>& tasks);
// "execution", "late", "inputs", "outputs" into an open object.
void activity_json(tools::JsonWriter& json, const vm::TaskActivity& activity);

}  // namespace stvm
