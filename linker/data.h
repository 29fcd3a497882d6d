// Tables about data memory: initial bytes, I/O bindings, retained ranges.
#pragma once

#include <vector>

#include "ir/bytecode/image.h"
#include "linker/instances.h"

namespace linker {

// Fills image.data, io, input_bytes, output_bytes and retain; instances, layouts
// and areas are set.
// A row of the process image for the variable at `data`; its area grows as far as needed.
void bind_address(ir::Image& image, const ir::DirectAddress& address, uint32_t data,
                  ir::TypeId type);

void fill_data_tables(ir::Image& image, const std::vector<InstanceNode>& nodes);

}  // namespace linker
