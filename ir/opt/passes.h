// The functions of passes.def, one file each. A pass may rely on a verified POU, and changes
// nothing but the POU that it is given. Other POUs are worked on at the same time: of them it reads
// the functions that the POU calls, and of the rest nothing that a pass changes. True: it changed
// something; run again at once, it finds nothing more that is worth the time.
#pragma once

#include "ir/program/ir.h"

namespace ir::opt {

#define PASS(id, name, function, what) bool function(const Program& program, Pou& pou);
#include "ir/opt/passes.def"
#undef PASS

// Instructions that a function's body adds where it is called; 0: calls of it stay calls.
uint32_t inlined_size(const Program& program, const Pou& pou);

}  // namespace ir::opt
