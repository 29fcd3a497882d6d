// The difference of two texts: which lines, and the unified form that `diff -u` and `patch` know.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stc {

// Lines [a, a_end) of one text become [b, b_end) of the other.
struct LineChange {
  size_t a, a_end, b, b_end;
};
// All of them, in order; each two have an equal line between them.
std::vector<LineChange> changes_between(const std::vector<std::string_view>& from,
                                        const std::vector<std::string_view>& to);

// Empty when they are equal. Lines are compared with their ends; for texts that differ in very many
// places the difference is correct but not the smallest.
std::string difference(std::string_view name, std::string_view before, std::string_view after);

}  // namespace stc
