// How what has an address lies in the process image: without slack, as a first version has it.
#pragma once

#include "ir/bytecode/image.h"

namespace ir {

// natural_layouts() of the types of Image::io; the types themselves are sound.
Layouts located_layouts(const Image& image);

}  // namespace ir
