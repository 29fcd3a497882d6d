// The limits of the tools' own work as constants; the table is tool_limits.def.
#pragma once

#include <cstdint>

namespace base {

#define LIMIT(id, value, what) inline constexpr uint32_t id = value;
#include "base/tool_limits.def"
#undef LIMIT

}  // namespace base
