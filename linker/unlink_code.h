// The code of one POU of an image -> a relocatable object: offsets and numbers become names of what
// they lead to.
#pragma once

#include <cstdint>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "linker/place_finder.h"

namespace linker {

// `pou` numbers a POU of the image that has code; `finder` is of the image. kUndefinedSymbol:
// something that the code names is not there, which no image has that was verified.
base::Result<ir::Object> unlink_code(const ir::Image& image, const PlaceFinder& finder,
                                     uint32_t pou);

}  // namespace linker
