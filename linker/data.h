// Tables about data memory: initial bytes, I/O bindings, retained ranges.
#pragma once

#include <vector>

#include "ir/bytecode/image.h"
#include "linker/instances.h"

namespace linker {

// Fills image.data, retain, and io for the variables whose address is part of their declaration;
// instances, layouts and areas are set.
void fill_data_tables(ir::Image& image, const std::vector<InstanceNode>& nodes);

// A row of the process image for the variable at `data`.
void bind_address(ir::Image& image, const ir::DirectAddress& address, uint32_t data,
                  ir::TypeId type);

// Sets input_bytes and output_bytes so that everything in image.io has its place. kTooMany when
// that is more than devices can exchange.
base::Status size_process_image(ir::Image& image);
// After it: sets devices, gives a map to those without one, and makes the process image cover all.
// kBadMapping where two of them do not go together.
base::Status place_devices(ir::Image& image, const std::vector<ir::Device>& devices);

}  // namespace linker
