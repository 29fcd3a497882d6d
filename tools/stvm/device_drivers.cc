#include "tools/stvm/device_drivers.h"

#include "vm/io/simulated_driver.h"

namespace stvm {

base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device) {
  const ir::DriverRow* row = ir::find_driver(device.driver);
  if (row != nullptr && row->id == ir::DriverId::kSimulated) {
    return vm::make_simulated_driver(device);
  }
  return base::Error{base::Refusal::kNoDriver,
                     "driver \"" + device.driver + "\" is not part of this stvm"};
}

base::Result<vm::DeviceIo::Options> device_options(const tools::Options& options,
                                                   vm::Clock* virtual_clock) {
  vm::DeviceIo::Options out{make_driver, {}, virtual_clock};
  for (const std::string& text : options.all("--device")) {
    base::Result<vm::DeviceOverride> row = vm::parse_device_override(text);
    if (!row.ok()) return row.error();
    out.overrides.push_back(std::move(*row));
  }
  return out;
}

}  // namespace stvm
