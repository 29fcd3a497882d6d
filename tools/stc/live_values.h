// Values for pictures: of a running controller, all of one boundary, or of a file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "frontend/draw/live.h"

namespace stc {

// The values of those of `names` that the controller at `place` (a state directory, or a host to
// ssh to) has, by the stvm beside this tool. Errors: what that one refuses.
base::Status fetch_values(const std::string& place, const std::vector<std::string>& names,
                          frontend::draw::Live& live);

// `NAME=VALUE` a line, as `stvm get` and `stvm run --print` write them; other lines say nothing.
void set_values(std::string_view lines, frontend::draw::Live& live);
// Those of a file.
base::Status read_values(const std::string& file, frontend::draw::Live& live);

}  // namespace stc
