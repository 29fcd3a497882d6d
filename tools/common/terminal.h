// Whether what is printed may have colours. One answer for the whole process, as every stream of it
// ends at the same person.
#pragma once

#include <string_view>

namespace tools {

// "auto", "always" or "never", of --color.
void choose_colour(std::string_view when);
// --color, else NO_COLOR (not empty: none), else CLICOLOR_FORCE (not empty and not 0: always), else
// whether `descriptor` is a terminal that knows them.
bool has_colour(int descriptor);

}  // namespace tools
