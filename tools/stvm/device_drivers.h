// The drivers that this stvm was built with.
#pragma once

#include "tools/common/options.h"
#include "vm/io/device_io.h"

namespace stvm {

// kNoDriver names the package that was missing; kDeviceFailed.
base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device);

#define STVM_DEVICE_OPTION                                                                       \
  {                                                                                              \
    "--device", "NAME.KEY=VALUE", "set a device differently on this controller; repeatable", "", \
        "", tools::Times::kMany                                                                  \
  }
// Writes a line for it on standard error, now and then only where there are too many.
void log_device(vm::DeviceEvent event, const std::string& device, const std::string& text);
// From that option; `virtual_clock` null: real time.
base::Result<vm::DeviceIo::Options> device_options(const tools::Options& options,
                                                   vm::Clock* virtual_clock);

}  // namespace stvm
