// An edit whose units start one after the other on a controller, each at a boundary of its own
// (E-25, E-26).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/part_edits.h"
#include "tools/stvm/fleet_result.h"

namespace stvm {

// Numbers of those of which the controller has nothing yet, in their order. `parts`: what the edit
// changes, and what the controller has.
std::vector<size_t> steps_to_come(const std::vector<std::string>& steps,
                                  const std::vector<ir::PartEdit>& parts,
                                  const ir::UnitMembers& members);
// Was the edit refused because there is no room for all of it at once?
bool lacks_room(const base::Error& why);
// What runs from `cycle` on, when the first `arrived` of those to come have come.
Mixture mixture_of(const std::vector<std::string>& steps, const std::vector<size_t>& to_come,
                   size_t arrived, uint64_t cycle);
// "from cycle 12: A new, Main as before"
std::string mixture_text(const Mixture& mixture);

}  // namespace stvm
