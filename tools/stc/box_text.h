// Boxes of FBD as the text form has them, taken apart for differences in words (X9).
#pragma once

#include <string>
#include <vector>

#include "frontend/network/network.h"
#include "tools/stc/units.h"

namespace stc {

// The rows of write_fbd(): boxes by their instance or wire, assignments by their variable, jumps.
// Comments are left out. `prefix`: in front of each name.
std::vector<UnitPart> box_parts(const frontend::network::Network& network,
                                const std::string& prefix);

// "PT: T#1s -> T#2s; R: none -> x"; empty when the two are no box of one type.
std::string differing_pins(const std::string& before, const std::string& after);

}  // namespace stc
