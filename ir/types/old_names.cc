#include "ir/types/old_names.h"

#include <algorithm>

#include "ir/types/types.h"

namespace ir {

namespace {

// The comma after the first name; one in an index is part of it.
size_t end_of_name(std::string_view rule) {
  bool index = false;
  for (size_t i = 0; i < rule.size(); ++i) {
    if (rule[i] == '[') index = true;
    if (rule[i] == ']') index = false;
    if (rule[i] == ',' && !index) return i;
  }
  return rule.size();
}

}  // namespace

std::vector<std::string_view> old_names_of(std::string_view rule) {
  std::vector<std::string_view> out;
  rule = rule.substr(0, rule.find(';'));
  while (!rule.empty()) {
    const size_t end = end_of_name(rule);
    if (end != 0) out.push_back(rule.substr(0, end));
    rule.remove_prefix(std::min(end + 1, rule.size()));
  }
  return out;
}

std::vector<PartRule> part_rules_of(std::string_view rule) {
  std::vector<PartRule> out;
  for (size_t at = rule.find(';'); at != std::string_view::npos; at = rule.find(';', at + 1)) {
    std::string_view part = rule.substr(at + 1);
    part = part.substr(0, part.find(';'));
    const size_t equals = part.find('=');
    if (equals == std::string_view::npos) continue;
    out.push_back({part.substr(0, equals), old_names_of(part.substr(equals + 1))});
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
