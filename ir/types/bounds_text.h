// "0..9", and "0..9,1..3" of an array, as sources have them; types are found again by these texts.
#pragma once

#include <string>
#include <vector>

#include "ir/types/types.h"

namespace ir {

std::string bounds_text(int64_t low, int64_t high);
std::string dimensions_text(const std::vector<Dimension>& dims);

}  // namespace ir
