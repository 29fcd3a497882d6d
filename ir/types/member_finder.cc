#include "ir/types/member_finder.h"

namespace ir {

MemberFinder::MemberFinder(const TypeTable& types, TypeId type) {
  if (type.valid()) members_ = &types[type].members;
}

std::optional<size_t> MemberFinder::find(const std::string& name) {
  if (members_ == nullptr || members_->empty()) return std::nullopt;
  if (next_ < members_->size() && same_name((*members_)[next_].name, name)) return next_++;
  if (numbers_.empty()) {
    numbers_.reserve(members_->size());
    for (size_t i = 0; i < members_->size(); ++i) {
      numbers_.emplace(fold_name((*members_)[i].name), i);
    }
  }
  const auto found = numbers_.find(fold_name(name));
  if (found == numbers_.end()) return std::nullopt;
  next_ = found->second + 1;
  return found->second;
}

}  // namespace ir
