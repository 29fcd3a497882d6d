// Where the references of a version lie.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

// A variable that holds a handle.
struct ReferenceLeaf {
  uint32_t at = 0;  // in data memory
  ir::TypeId type;  // of the variable
};
// All of them but those in unions, by area. Cost: areas without any, and each one.
std::vector<ReferenceLeaf> reference_leaves(const ir::Image& image);

}  // namespace online_change
