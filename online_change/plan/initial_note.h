// What a report says of a variable that keeps its value while its initial value is another one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "online_change/diff/areas.h"
#include "online_change/diff/initial_data.h"

namespace online_change {

// Neighbours of one size: where they begin in data memory, and how far it is from one to the next.
struct Values {
  uint32_t begin;
  uint32_t stride;
};

// "; initial value 3 -> 4, the live value stays". Where there is more than one value, the first
// that changed: "; initial value of .gain 1.0 -> 1.5 (and others), ...". `path`: of the variable.
// `before` are in `areas`, as many as `after`; all have the same type in both versions.
std::string initial_note(const Areas& areas, const InitialData& old_data, Values before,
                         const InitialData& new_data, Values after, uint32_t size, uint32_t count,
                         std::string_view path);

}  // namespace online_change
