// Values as commands print them.
#pragma once

#include "vm/runtime/protocol.h"

namespace stvm {

// "path=value" lines; {"cycle":..,"values":{path:value}} as JSON.
std::string values_text(const vm::Values& values);
std::string values_json(const vm::Values& values);

}  // namespace stvm
