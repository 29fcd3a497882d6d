// What virtual calls run, where the calls themselves are not at hand.
#pragma once

#include <set>
#include <vector>

#include "ir/program/ir.h"

namespace ir {

// As find_overrides(program), for these prototypes and those that code of the program calls.
std::vector<Override> find_overrides(const Program& program, std::set<PouId> prototypes);

}  // namespace ir
