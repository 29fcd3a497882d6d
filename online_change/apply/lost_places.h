// Where the values are that have no place in the next version (X1): fate rows stand for what many
// instances have in common, a loss is told for each of them by its own path.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "online_change/plan/plan.h"

namespace online_change {

// Places in the old version. However many rows there are, and whoever made them: an instance is in
// two groups at most.
struct LostPlaces {
  struct Row {
    bool dropped = false;
    uint32_t group = 0;  // the instances that share it
    std::string inside;  // "" for the whole instance, else ".member" and so on; "[0..9].x": several
    uint64_t elements = 1;  // that `inside` stands for
    bool outside = false;   // only elements outside of the new bounds
    bool constant = false;  // what the new version has there: only another value is a loss
  };
  std::vector<Row> rows;
  std::vector<std::vector<uint32_t>> groups;  // IDs; 0: the globals
};

// Number `number` of the elements that a path with ranges stands for, the last index fastest:
// "[0..1,2..3].x", 1 -> "[0,3].x".
std::string element_of(const std::string& inside, uint64_t number);

// The rows of `plan` that drop a value, or give a variable another type to which no rule leads from
// the old one. `old_image` has the names of the new one (ir/bytecode/renames.h). A row whose path
// is of no instance is about the globals.
LostPlaces lost_places(const Plan& plan, const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
