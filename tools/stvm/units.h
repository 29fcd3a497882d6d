// The table of units (D8) as people and scripts read it.
#pragma once

#include <string>
#include <vector>

#include "tools/stvm/unit_message.h"

namespace stvm {

std::string units_text(const std::vector<UnitRow>& rows);
std::string units_json(const std::vector<UnitRow>& rows);

}  // namespace stvm
