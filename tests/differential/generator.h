// Random valid programs over the language that the compiler supports. The same seed gives the
// same program everywhere.
#pragma once

#include <cstdint>

#include "tests/differential/tree.h"

namespace differential {

// Without `overlays` there is no reference and no union in it.
Program random_program(uint64_t seed, bool overlays);

}  // namespace differential
