// The old names that one rule gives, the latest first: {renamed from := 'b', 'a'} of what was `b`
// in one running version and `a` in one before it. A rule is kept as one text, with commas. Of a
// variable there are also rules for its parts: `b,a;.x=c,d.y` says that its member x was `c`, or
// member y of `d`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ir {

std::vector<std::string_view> old_names_of(std::string_view rule);
struct PartRule {
  std::string_view part;  // ".x", "[3].y"
  std::vector<std::string_view> old_names;
};
std::vector<PartRule> part_rules_of(std::string_view rule);
// Without repetitions.
std::string old_names_rule(const std::vector<std::string>& names);
// Is `name` one of them?
bool gives_old_name(std::string_view rule, std::string_view name);

}  // namespace ir
