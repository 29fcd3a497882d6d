// `*` and `?` in names of variables, tests and files; nothing else is special.
#pragma once

#include <cstddef>
#include <string_view>

namespace tools {

// Without case.
bool matches(std::string_view pattern, std::string_view name);
// With case.
bool matches_file(std::string_view pattern, std::string_view name);

// Does `name` consist of what `pattern` says, part by part? A part of the pattern for which
// `is_star` holds stands for any number of parts. Greedy with one step back to the last of these:
// linear for all that people type, and never more than the product of both lengths.
template <class Pattern, class Name, class IsStar, class Same>
bool matches_parts(const Pattern& pattern, const Name& name, IsStar is_star, Same same) {
  size_t p = 0;
  size_t n = 0;
  size_t behind_star = 0;  // 0: there was none
  size_t resume = 0;
  while (n < name.size()) {
    if (p < pattern.size() && is_star(pattern[p])) {
      behind_star = ++p;
      resume = n;
    } else if (p < pattern.size() && same(pattern[p], name[n])) {
      ++p;
      ++n;
    } else if (behind_star != 0) {
      p = behind_star;
      n = ++resume;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && is_star(pattern[p])) ++p;
  return p == pattern.size();
}

}  // namespace tools
