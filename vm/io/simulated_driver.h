// A device that is two files: inputs come from one (csv_inputs.h), outputs go to the other
// (csv_outputs.h). On a virtual clock the same run gives the same files every time.
#pragma once

#include "vm/io/driver.h"

namespace vm {

// kDeviceFailed: a file cannot be read or written, or has a column that is not mapped.
base::Result<std::unique_ptr<IoDriver>> make_simulated_driver(const ir::Device& device);

}  // namespace vm
