// Where the values are that have no place in the next version (X1): fate rows stand for what many
// instances have in common, a loss is told for each of them by its own path.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "online_change/plan/plan.h"

namespace online_change {

struct LostPlace {
  uint32_t row = 0;                 // of the plan's fates
  std::vector<uint32_t> instances;  // of the old version, by ID; 0: the globals
  std::string inside;               // "" for the whole instance, else ".member" and so on

  // In the old version. `number` counts the instances.
  std::string path(const ir::Image& old_image, size_t number) const;
};

// The rows of `plan` that drop a value, or give a variable another type to which no rule leads from
// the old one. `old_image` has the names of the new one (ir/bytecode/renames.h).
std::vector<LostPlace> lost_places(const Plan& plan, const ir::Image& old_image,
                                   const ir::Image& new_image);

}  // namespace online_change
