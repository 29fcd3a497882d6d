// Addresses for variables AT %I*, %Q* and %M* to which VAR_CONFIG gives none. Each begins at a byte
// of its own, aligned, so no byte has two writers. With a base, a variable that lives on in the
// same size keeps its address unless something is declared there now; new ones take the lowest
// bytes that neither version uses, in the order of declarations. Without one, the same sources give
// the same addresses.
#pragma once

#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "linker/instances.h"

namespace linker {

// Adds to image.io, which has all other addresses. kTooMany: no address is left.
base::Status give_addresses(ir::Image& image, const std::vector<InstanceNode>& nodes,
                            const ir::Image* base);

}  // namespace linker
