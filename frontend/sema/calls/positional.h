// Arguments without names: which parameters they are for.
#pragma once

#include <span>
#include <vector>

#include "frontend/sema/declarations.h"

namespace frontend {

// Of a POU with these variables, for `count` arguments. A call that gives all parameters has them
// in the order of their declaration (IEC 61131-3, 6.6.1.4.2). One that gives fewer has inputs and
// in-outs in their order, and then outputs, as in CODESYS.
std::vector<VarId> positional_parameters(const Declarations& declared,
                                         std::span<const VarId> variables, VarId result,
                                         uint32_t count);

}  // namespace frontend
