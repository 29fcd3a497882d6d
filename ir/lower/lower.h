// IR -> relocatable object, one POU at a time. Needs types and signatures of the
// program, never a layout. Deterministic.
#pragma once

#include <vector>

#include "base/result.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"

namespace ir {

// kTooMany when the POU exceeds a limit of the object format.
base::Result<Object> lower(const Program& program, PouId pou);

// Every POU but those in `left_out` (by PouId; may be shorter), in order, on up to `jobs` threads;
// of several errors the first POU's.
base::Result<std::vector<Object>> lower_all(const Program& program,
                                            const std::vector<bool>& left_out, uint32_t jobs);
// The same; gives the memory of each body back when its object is made. What remains of the program
// is what the linker reads.
base::Result<std::vector<Object>> lower_all_away(Program& program,
                                                 const std::vector<bool>& left_out, uint32_t jobs);

}  // namespace ir
