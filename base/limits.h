// The fixed limits of the product as constants; the table is limits.def.
#pragma once

#include <cstdint>

namespace base {

#define LIMIT(id, value, what) inline constexpr uint32_t id = value;
#include "base/limits.def"
#undef LIMIT

}  // namespace base
