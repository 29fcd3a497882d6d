#include "ir/types/old_names.h"

#include <algorithm>

#include "ir/types/types.h"

namespace ir {

std::vector<std::string_view> old_names_of(std::string_view rule) {
  std::vector<std::string_view> out;
  while (!rule.empty()) {
    const size_t end = std::min(rule.find(','), rule.size());
    if (end != 0) out.push_back(rule.substr(0, end));
    rule.remove_prefix(std::min(end + 1, rule.size()));
  }
  return out;
}

std::string old_names_rule(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) {
    if (name.empty() || gives_old_name(out, name)) continue;
    if (!out.empty()) out += ',';
    out += name;
  }
  return out;
}

bool gives_old_name(std::string_view rule, std::string_view name) {
  const std::vector<std::string_view> names = old_names_of(rule);
  return std::any_of(names.begin(), names.end(),
                     [&](std::string_view one) { return same_name(one, name); });
}

}  // namespace ir
