// What a tool says about itself from its tables of options: to people, in at most 80 columns, and
// to programs, which make completion and manual pages of it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "tools/common/options.h"

namespace tools {

// Text of `TOOL COMMAND --help`.
std::string help_text(std::string_view tool, const Command& command);
// Text of `TOOL --help`.
std::string overview(std::string_view tool, std::string_view purpose,
                     std::span<const Command* const> commands);
// `TOOL help --format json`.
std::string help_json(std::string_view tool, std::string_view purpose,
                      std::span<const Command* const> commands);
// Among `args`, is there a --help?
bool wants_help(std::span<char* const> args);

}  // namespace tools
