// Long texts for people, as lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace base {

// Broken at blanks into lines of at most so many bytes, but for longer words; blanks and line ends
// in a row are one blank.
std::vector<std::string> wrapped(std::string_view text, size_t columns);

}  // namespace base
