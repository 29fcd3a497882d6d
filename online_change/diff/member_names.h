// Members of a type by name, whatever the case.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_map>

#include "ir/bytecode/image.h"

namespace online_change {

// A program may have very many.
class MemberNames {
 public:
  static constexpr uint32_t kNone = 0xffffffffu;
  explicit MemberNames(const ir::Type& type) {
    for (uint32_t i = 0; i < type.members.size(); ++i) {
      numbers_.emplace(ir::fold_name(type.members[i].name), i);
    }
  }
  uint32_t find(const ir::Member& member) const {
    auto found = numbers_.find(ir::fold_name(member.name));
    return found == numbers_.end() ? kNone : found->second;
  }

 private:
  std::unordered_map<std::string, uint32_t> numbers_;
};

}  // namespace online_change
