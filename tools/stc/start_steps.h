// How the units of a fleet file start: all together, or one after the other, and in which order
// (E-23 to E-25).
#pragma once

#include <string>
#include <vector>

#include "linker/edit_steps.h"
#include "tools/common/options.h"

namespace stc {

// The steps of the start; none: all units together. Errors name the step that cannot come there:
// kUsage, kCannotRelink. kMixture: a unit would run with an old version of one that it calls,
// without --allow-mixture (E-24).
base::Result<std::vector<std::string>> start_steps(const tools::Options& options,
                                                   const linker::EditImages& edit);
// A line for each.
std::string order_text(const std::vector<std::string>& steps);

}  // namespace stc
