// The other way round than link(): an image -> the program and the objects that it was linked from,
// as far as linking needs them. So code can go from one image to another without its source: what
// it names is found by name there (E-09, E-10), and an edit can be taken out of the middle of
// several (D3).
//
// Linked again on top of the image itself, the result is the image, byte for byte. What an image
// does not tell is how offsets behind handles, and sizes (SIZEOF), came about: they stay numbers,
// and the object is `fixed` to the layouts of its types.
#pragma once

#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"

namespace linker {

struct Unlinked {
  ir::Program program;              // POUs without their code
  std::vector<ir::Object> objects;  // in the order of Image::pous, without unused numbers
  std::vector<ir::Device> devices;
  std::vector<ir::SafeOutput> safe;
};

// `image` is verified: of others it says kUndefinedSymbol, or is wrong.
base::Result<Unlinked> unlink(const ir::Image& image);

}  // namespace linker
