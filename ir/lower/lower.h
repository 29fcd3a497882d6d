// IR -> relocatable object, one POU at a time. Needs types and signatures of the
// program, never a layout. Deterministic.
#pragma once

#include "base/result.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"

namespace ir {

// kTooMany when the POU exceeds a limit of the object format.
base::Result<Object> lower(const Program& program, PouId pou);

}  // namespace ir
