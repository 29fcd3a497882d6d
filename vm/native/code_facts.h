// What the machine code of a POU relies on beside its units.
#pragma once

#include <vector>

#include "base/hash.h"
#include "vm/native/facts.h"

namespace vm::native {

// Constants, bounds, ranges and callees that the units name by number, and where the instances
// inside lie. Code whose units and digest stay the same is still right. `scratch`: to be used
// again.
base::Digest facts_of(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                      std::vector<uint64_t>& scratch);

// Do facts_of() two versions rely on the same tables, as far as the first one has them?
bool rely_on_the_same(const ir::Image& before, const ir::Image& after);
// Then: are those of this POU, which both have, the same? False says nothing.
bool have_same_facts(const ir::Image& before, const ir::Image& after, uint32_t number);

}  // namespace vm::native
