// Values that memory is known to hold, where no variable names it: where inlined bodies meet their
// callers, and in elements and structures.
#pragma once

#include "vm/native/lir.h"

namespace vm::native {

// A load of what a store or a load before has brought becomes that value. The stores stay: memory
// is right. Nothing is known after calls and where loops begin.
void forward_memory(Function& function);

}  // namespace vm::native
