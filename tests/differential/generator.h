// Random valid programs over the language that the compiler supports. The same seed gives the
// same program everywhere.
#pragma once

#include <cstdint>

#include "tests/differential/tree.h"

namespace differential {

// Without `construction` no function block has an FB_Init: it runs at a cold start only. `iec`: valid
// with that dialect, which has fewer implicit conversions and operators, and no extensions.
Program random_program(uint64_t seed, bool construction, bool iec = false);

}  // namespace differential
