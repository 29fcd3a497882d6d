// Process images in POSIX shared memory (shared_memory.h). The controller creates it and writes
// the outputs; whoever else opens it writes the inputs. Communication is lost while nobody has
// written inputs for timeout_ms.
#pragma once

#include "vm/io/driver.h"

namespace vm {

// kDeviceFailed: the name is none.
base::Result<std::unique_ptr<IoDriver>> make_shared_memory_driver(const ir::Device& device);

}  // namespace vm
