// A trap as one line for people.
#pragma once

#include <string>

#include "vm/runtime/protocol.h"

namespace stvm {

// "cycle 12, task Fast: pump.st:7 (Pump): array index outside its bounds"
std::string trap_text(const vm::TrapRow& trap);
std::string trap_text(const vm::TrapRecord& trap);

}  // namespace stvm
