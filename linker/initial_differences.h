// What the initial data of an instance has that its type does not say: overrides in the declaration
// of a program instance, and in VAR_CONFIG. An image has them as bytes only.
#pragma once

#include <cstdint>

#include "ir/bytecode/image.h"

namespace linker {

// Adds what is needed to `constants`, which begins as the image's. Invalid: nothing differs.
ir::ConstId initial_difference(const ir::Image& image, ir::ConstTable& constants,
                               uint32_t instance);

}  // namespace linker
