// Text of somebody else for a terminal: what would move its cursor, colour it or type for its user
// is shown instead of sent.
#pragma once

#include <string>
#include <string_view>

namespace base {

// Control characters (C0, DEL, C1) and bytes that are no UTF-8 become \x1b, all else stays.
std::string visible(std::string_view text);
// Of text of several lines, which stay lines.
std::string visible_lines(std::string_view text);

}  // namespace base
