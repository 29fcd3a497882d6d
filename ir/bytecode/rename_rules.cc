#include "ir/bytecode/rename_rules.h"

#include "ir/types/old_names.h"
#include "ir/types/types.h"

namespace ir {

void RenameRules::add(std::string_view name, std::string_view from, uint32_t number) {
  rules_.push_back({fold_name(name), fold_name(from), number, true});
}

void RenameRules::resolve(const Numbers& old, const std::function<std::string(uint32_t)>& carried,
                          const std::function<void(uint32_t, uint32_t)>& apply) {
  old_ = &old;
  for (uint32_t i = 0; i < rules_.size(); ++i) {
    Rule& rule = rules_[i];
    rule.from = first_known(rule.from);
    const uint32_t there = find(old, rule.name);
    const bool known = !rule.from.empty() && rule.from != rule.name;
    const bool done = there != kNone && gives_old_name(carried(there), rule.from);
    by_name_.emplace(rule.name, i);
    if (!known || done || !by_source_.emplace(rule.from, i).second) rule.applies = false;
  }
  for (uint32_t i = 0; i < rules_.size(); ++i) {
    if (rules_[i].applies && !is_vacated(rules_[i].name)) drop(i);
  }
  for (const Rule& rule : rules_) {
    if (rule.applies) apply(find(old, rule.from), rule.number);
  }
}

uint32_t RenameRules::find(const Numbers& numbers, const std::string& name) {
  const auto found = numbers.find(name);
  return found == numbers.end() ? kNone : found->second;
}

// The latest of the old names that the running version has.
std::string RenameRules::first_known(const std::string& names) const {
  for (std::string_view name : old_names_of(names)) {
    if (find(*old_, std::string(name)) != kNone) return std::string(name);
  }
  return {};
}

// Is the name free in the running version, or made free by another rule?
bool RenameRules::is_vacated(const std::string& name) const {
  if (find(*old_, name) == kNone) return true;
  const uint32_t taker = find(by_source_, name);
  return taker != kNone && rules_[taker].applies;
}

// A rule that does not apply frees no name.
void RenameRules::drop(uint32_t rule) {
  while (rule != kNone && rules_[rule].applies) {
    rules_[rule].applies = false;
    rule = find(by_name_, rules_[rule].from);
  }
}

}  // namespace ir
