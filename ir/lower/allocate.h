// Frame slots for registers: linear scan; slots are reused by registers of the
// same class (and, for addrs, of the same region).
#pragma once

#include "ir/bytecode/object.h"
#include "ir/lower/liveness.h"
#include "ir/lower/machine.h"

namespace ir::codegen {

// Adds the temporaries' slots to `object` and sets Register::slot of every register
// that code uses.
void allocate(Machine& machine, const Liveness& liveness, Object& object);

}  // namespace ir::codegen
