// Verbs of stvm that are programs of their own beside it: controllers do without what they contain.
#pragma once

#include "tools/common/options.h"

namespace stvm {

// Runs `program` of the own folder with the command line that was given, in place of this process.
// The exit code, where it cannot be run. `package`: it comes with that one.
int hand_over(const tools::Command& command, const char* program, const char* package,
              const tools::Options& options);

}  // namespace stvm
