// Modbus TCP and RTU, as client and as server, by libmodbus.
#pragma once

#include "vm/io/driver.h"

namespace modbus {

// Makes the driver of a checked device with one of the four drivers. kDeviceFailed when a setting
// cannot be used; that nobody answers is found by exchanging.
base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device);

}  // namespace modbus
