// Several turns of a small counted loop at once.
#pragma once

#include "vm/native/lir.h"

namespace vm::native {

// After split_addresses(): in front of such a loop stands one that does some of its turns
// together. Fuel is taken for all of them at once, when more than that is left; addresses that move
// with the counter become displacements. What is left to do, and what ends for want of fuel, the
// loop itself does.
void unroll(Function& function);

}  // namespace vm::native
