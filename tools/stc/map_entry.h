// One entry of a device's `map`: "coil 0..15 <- %QX0.0", "input 3 -> %IW2".
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/bytecode/devices.h"

namespace stc {

struct MapFault {
  size_t at = 0;  // character of the entry
  std::string text;
};

// Fills `mapping`; what the entry says is checked by ir::find_fault().
std::optional<MapFault> parse_map_entry(std::string_view text, ir::DeviceMapping& mapping);

}  // namespace stc
