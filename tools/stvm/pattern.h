// `*` and `?` in names of variables, without case; nothing else is special.
#pragma once

#include <string_view>

namespace stvm {

bool matches(std::string_view pattern, std::string_view name);

}  // namespace stvm
