// The comment at a declaration: what stands in the lines directly above it, attributes left out;
// else what follows in its own line; else, at a POU, what stands directly below its head.
#pragma once

#include <string>
#include <string_view>

namespace frontend::questions {

// `text`: a source file. `name`: where the declared name begins in it. `below`: look below, too.
// The comments' text without their marks, a line each; "": there are none.
std::string documentation(std::string_view text, size_t name, bool below);

}  // namespace frontend::questions
