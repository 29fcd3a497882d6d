// What the machine code of a POU relies on beside its units.
#pragma once

#include <vector>

#include "base/hash.h"
#include "ir/bytecode/constant_range.h"
#include "vm/native/facts.h"

namespace vm::native {

// Constants, bounds, ranges and callees that the units name by number, and where the instances
// inside lie. Code whose units and digest stay the same is still right. `scratch`: to be used
// again.
base::Digest facts_of(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                      std::vector<uint64_t>& scratch);

// Do units of the POU name constants there?
bool names_constants(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                     ir::ConstantRange there);

}  // namespace vm::native
