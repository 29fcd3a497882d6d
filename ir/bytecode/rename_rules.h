// The rules of one scope (the types, a type's members, a type's literals, the programs), and which
// of them apply to a running version (renames.h).
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace ir {

class RenameRules {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  using Numbers = std::unordered_map<std::string, uint32_t>;  // by folded name

  // `from`: the old names, the latest first.
  void add(std::string_view name, std::string_view from, uint32_t number);
  bool empty() const { return rules_.empty(); }

  // `old`: the scope's names in the running version; `carried`: the rule that one of them has
  // there. Calls apply(old number, new number).
  void resolve(const Numbers& old, const std::function<std::string(uint32_t)>& carried,
               const std::function<void(uint32_t, uint32_t)>& apply);

 private:
  struct Rule {
    std::string name;
    std::string from;  // at last the one old name that it is about
    uint32_t number = 0;
    bool applies = true;
  };

  static uint32_t find(const Numbers& numbers, const std::string& name);
  std::string first_known(const std::string& names) const;
  bool is_vacated(const std::string& name) const;
  void drop(uint32_t rule);

  std::vector<Rule> rules_;
  Numbers by_name_;
  Numbers by_source_;
  const Numbers* old_ = nullptr;
};

}  // namespace ir
