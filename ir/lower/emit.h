// Machine instructions -> units of the object, with jumps, merge lists and lines.
#pragma once

#include "base/result.h"
#include "ir/bytecode/object.h"
#include "ir/lower/liveness.h"
#include "ir/lower/machine.h"

namespace ir::codegen {

base::Status emit_object(const Machine& machine, const Liveness& liveness, Object& object);

}  // namespace ir::codegen
