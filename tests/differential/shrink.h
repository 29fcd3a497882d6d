// Delta debugging on the tree: removes what can be removed, and replaces what can be simpler, as
// long as the program still fails in the same way.
#pragma once

#include <functional>

#include "tests/differential/tree.h"

namespace differential {

// True when the program fails as the original one did. It may be one that does not compile.
using StillFails = std::function<bool(const Program&)>;

Program shrink(Program program, const StillFails& fails);

}  // namespace differential
