// `*` and `?` in names of variables and tests, without case; nothing else is special.
#pragma once

#include <string_view>

namespace tools {

bool matches(std::string_view pattern, std::string_view name);

}  // namespace tools
