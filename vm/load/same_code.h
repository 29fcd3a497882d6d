// Which POUs of two versions are the same code: whatever is found out of one holds of the other.
#pragma once

#include <cstdint>

#include "ir/bytecode/image.h"

namespace vm {

// Do numbers of POUs, types and bounds mean the same in both versions, and do instances lie where
// they did? Then the same code has the same variables. False says nothing.
bool have_same_places(const ir::Image& before, const ir::Image& after);
// The same, and does code rely on the same tables, as far as both have them: ranges, methods that
// override others? Then the same code does the same, but for its constants.
bool stand_on_the_same(const ir::Image& before, const ir::Image& after);
// Then: is this POU, which both have, the same code? False says nothing.
bool have_same_code(const ir::Image& before, const ir::Image& after, uint32_t number);

}  // namespace vm
