// The way through a fleet (E-27, E-30): one controller after the other, some at once, or each when
// it answers.
#pragma once

#include <functional>
#include <vector>

#include "tools/stvm/fleet_list.h"
#include "tools/stvm/fleet_result.h"

namespace stvm {

struct FleetWalk {
  uint32_t jobs = 1;        // visits at once, on threads
  bool one_by_one = false;  // comes back to those that cannot be reached until they can
  std::function<FleetRow(const FleetMember&)> visit;
  // By one_by_one: does it answer? Once a second for each that did not.
  std::function<bool(const FleetMember&)> answers;
  // After each visit; one at a time.
  std::function<void(const FleetMember&, const FleetRow&)> told;
};

// Rows in the order of the members.
std::vector<FleetRow> walk(const std::vector<FleetMember>& members, const FleetWalk& how);

}  // namespace stvm
