// The difference of two texts in the unified form that `diff -u` and `patch` know.
#pragma once

#include <string>
#include <string_view>

namespace stc {

// Empty when they are equal. Lines are compared with their ends; for texts that differ in very many
// places the difference is correct but not the smallest.
std::string difference(std::string_view name, std::string_view before, std::string_view after);

}  // namespace stc
