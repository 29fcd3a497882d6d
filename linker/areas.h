// Places for the areas of globals and instances in data memory (A5). With a base,
// an area stays where it is while its capacity is unchanged; others go first fit
// into what was free in the running version, when nothing else is left into what this
// change frees, and then into data memory that grows by the free area of the
// project (A7, A19, case 71).
#pragma once

#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/types/layout.h"
#include "linker/layout.h"

namespace linker {

struct AreaPlan {
  std::vector<ir::Extent> free;
  uint32_t data_capacity = 0;
};

// Sets `data` of every live row of `image.instances`; its types and layouts are set.
base::Result<AreaPlan> place_areas(ir::Image& image, const Slack& slack, const ir::Image* base,
                                   bool move_all);

}  // namespace linker
