// The client's side: asks for every mapped range in requests as large as Modbus allows, writes
// first. All of an exchange must be done within timeout_ms; after any failure but an exception of
// the device the line is opened anew, so that a late answer is never taken for another one's.
#pragma once

#include "adapters/modbus/line.h"

namespace modbus {

std::unique_ptr<vm::IoDriver> make_client(const ir::Device& device, Context context);

}  // namespace modbus
