// Random valid programs over the language that the compiler supports. The same seed gives the
// same program everywhere.
#pragma once

#include <cstdint>

#include "tests/differential/tree.h"

namespace differential {

Program random_program(uint64_t seed);

}  // namespace differential
