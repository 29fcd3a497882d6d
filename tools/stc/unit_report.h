// Differences of units as people and scripts read them (X9).
#pragma once

#include <string>
#include <vector>

#include "tools/common/json.h"
#include "tools/stc/unit_difference.h"

namespace stc {

std::string difference_text(const std::vector<UnitDifference>& units);
// "units" into an open object.
void difference_json(const std::vector<UnitDifference>& units, tools::JsonWriter& json);

}  // namespace stc
