// What a change does to the field devices: in the report beside fates and code. Map entries that go
// leave their outputs at zero (docs/IO.md).
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

struct DeviceEdit {
  std::string device;
  std::string what;  // "new", "removed", "address plc:502 -> plc:503", "no longer coil 0 <- %QX0.0"
};
// By name, in order of what is said of each.
std::vector<DeviceEdit> device_edits(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
