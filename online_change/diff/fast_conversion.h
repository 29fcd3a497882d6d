// Conversions of many neighbouring values at machine speed, for the boundary: only
// what is exact. The rules are those of value_conversion.h, which handles the rest.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ir/types/types.h"

namespace online_change {

struct ValueRun {
  const uint8_t* from = nullptr;
  size_t from_stride = 0;
  uint8_t* to = nullptr;  // without gaps
  size_t count = 0;
};
// Converts values from the front; returns how many, up to the first that is not exact.
using FastConverter = size_t (*)(const ValueRun& run);

// Null where there is none: enumerations by name, subranges, strings, times.
FastConverter fast_converter(const ir::TypeTable& old_types, ir::TypeId old_type,
                             const ir::TypeTable& new_types, ir::TypeId new_type);

}  // namespace online_change
