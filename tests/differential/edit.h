// Random changes of a random program: what people do to a program between two downloads. Nothing is
// renamed; what mentions something that is gone or has another type goes too.
#pragma once

#include <cstdint>

#include "tests/differential/tree.h"

namespace differential {

// The result need not compile: an edit may leave a use that nobody saw.
Program edited(Program program, uint64_t seed);

}  // namespace differential
