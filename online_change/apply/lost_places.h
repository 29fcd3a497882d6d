// Where the values are that have no place in the next version (X1): fate rows stand for what many
// instances have in common, a loss is told for each of them by its own path.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "online_change/plan/plan.h"

namespace online_change {

// Of the old version. However many rows there are, and whoever made them: an instance is in two
// groups at most.
struct LostPlaces {
  struct Row {
    uint32_t fate = 0;   // row of the plan's fates
    uint32_t group = 0;  // the instances that share it
    std::string inside;  // "" for the whole instance, else ".member" and so on
  };
  std::vector<Row> rows;
  std::vector<std::vector<uint32_t>> groups;  // IDs; 0: the globals

  uint64_t count() const;
};

// The rows of `plan` that drop a value, or give a variable another type to which no rule leads from
// the old one. `old_image` has the names of the new one (ir/bytecode/renames.h). A row whose path
// is of no instance is about the globals.
LostPlaces lost_places(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
