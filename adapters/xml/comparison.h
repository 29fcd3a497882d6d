// Boxes that compare, as the contacts of a ladder that they are here: [ n > 5 ].
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace xml {

// The sign of `box`, GT, GE, EQ, LE, LT or NE; "" of others.
std::string_view comparison_sign(std::string_view box);
// `a > b`; with more operands, or where one is more than a name or number, `GT(a, b, c)`.
std::string comparison_text(std::string_view box, std::span<const std::string> operands);

}  // namespace xml
