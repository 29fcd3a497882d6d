// The tables [devices.NAME] of stc.toml (docs/IO.md): read, checked, and resolved to bits of the
// process image. Every mistake is kBadMapping with the line and column of what is wrong.
#pragma once

#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/devices.h"
#include "tools/common/toml.h"

namespace stc {

inline constexpr std::string_view kDeviceTables = "devices.";

// Sorted by name. Other keys of `table` are left alone.
base::Result<std::vector<ir::Device>> read_devices(std::string_view file,
                                                   const tools::TomlTable& table);

}  // namespace stc
