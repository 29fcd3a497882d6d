// Addresses that no declaration has: those that VAR_CONFIG gives to variables of single instances.
#pragma once

#include <vector>

#include "ir/bytecode/image.h"

namespace ir {

// In the order of Image::io.
std::vector<LocatedPath> located_paths(const Image& image);

}  // namespace ir
