#include "tools/stvm/device_drivers.h"

#include <cstdio>

#include "vm/io/shared_memory_driver.h"
#include "vm/io/simulated_driver.h"
#ifdef STC_HAS_MODBUS
#include "adapters/modbus/modbus_drivers.h"
#endif

namespace stvm {

base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device) {
  const ir::DriverRow* row = ir::find_driver(device.driver);
  if (row == nullptr) {
    return base::Error{base::Refusal::kNoDriver,
                       "driver \"" + device.driver + "\" is unknown here"};
  }
  switch (row->id) {
    case ir::DriverId::kSimulated:
      return vm::make_simulated_driver(device);
    case ir::DriverId::kSharedMemory:
      return vm::make_shared_memory_driver(device);
    default:
      break;
  }
#ifdef STC_HAS_MODBUS
  return modbus::make_driver(device);
#else
  return base::Error{base::Refusal::kNoDriver,
                     "driver \"" + device.driver +
                         "\" is not part of this stvm: it was built without libmodbus (package "
                         "libmodbus-dev)"};
#endif
}

// One call for each line, so that those of two threads do not mix.
static void log_device(const std::string& line) { std::fprintf(stderr, "%s\n", line.c_str()); }

base::Result<vm::DeviceIo::Options> device_options(const tools::Options& options,
                                                   vm::Clock* virtual_clock) {
  vm::DeviceIo::Options out{make_driver, {}, virtual_clock, log_device,
                              options.has("--seccomp")};
  for (const std::string& text : options.all("--device")) {
    base::Result<vm::DeviceOverride> row = vm::parse_device_override(text);
    if (!row.ok()) return row.error();
    out.overrides.push_back(std::move(*row));
  }
  return out;
}

}  // namespace stvm
