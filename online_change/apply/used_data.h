// Where in data memory the values of a version lie: what is copied when all of them are.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

// Areas of live instances and of the globals, slack included, in order and joined.
std::vector<ir::Extent> used_extents(const ir::Image& image);
uint64_t total_bytes(const std::vector<ir::Extent>& extents);

}  // namespace online_change
