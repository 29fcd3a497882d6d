// The fixed limits of the product as constants; the table is limits.def.
#pragma once

#include <cstdint>

namespace base {

#define LIMIT(id, value, what) inline constexpr uint32_t id = value;
#include "base/limits.def"
#undef LIMIT

// Types in types, the whole included: no verified image has more.
inline constexpr uint32_t kMaxTypeDepth = kMaxNesting + 1;

}  // namespace base
