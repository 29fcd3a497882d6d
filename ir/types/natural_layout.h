// Layouts as a first version has them when nothing else decides: members one after the other,
// aligned, no slack. For whoever has types but no image.
#pragma once

#include "ir/types/layout.h"

namespace ir {

inline constexpr uint32_t kSlotBytes = 4;  // of a VAR_IN_OUT: the number of what it stands for

// `types` is complete and verified: no type contains itself, sizes fit 32 bits.
Layouts natural_layouts(const TypeTable& types);

}  // namespace ir
