// Instances for which FB_Exit runs, because only one of two versions has them.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

struct Leaving {
  std::vector<uint32_t> at_switch;  // instances of the old version
  std::vector<uint32_t> at_undo;    // of the new one
};
// Instances that leave: those with a stamp (ir/types/stamps.h), the ones around others first.
Leaving find_leaving(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
