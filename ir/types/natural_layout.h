// Layouts as a first version has them when nothing else decides: members one after the other,
// aligned, no slack. For whoever has types but no image.
#pragma once

#include <span>

#include "ir/types/layout.h"

namespace ir {

inline constexpr uint32_t kSlotBytes = 4;  // of a VAR_IN_OUT: the number of what it stands for

// `types` is complete and verified: no type contains itself, sizes fit 32 bits.
Layouts natural_layouts(const TypeTable& types);
// Only of these and of what they are made of; the others have none. A large program has few types
// of variables with an address.
Layouts natural_layouts(const TypeTable& types, std::span<const TypeId> wanted);

// Of a value of one type that is complete; the others may still be made.
uint32_t natural_size(const TypeTable& types, TypeId type);

}  // namespace ir
