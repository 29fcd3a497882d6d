// Values as commands print them.
#pragma once

#include "vm/runtime/protocol.h"

namespace stvm {

// "path=value" lines; {"cycle":..,"last_cycle":..,"values":{path:value}} as JSON.
std::string values_text(const vm::Values& values);
std::string values_json(const vm::Values& values);
// How forces hold: a line for each; with `json` an object.
std::string forces_text(const vm::ForceRows& forces);
std::string forces_json(const vm::ForceRows& forces);

}  // namespace stvm
