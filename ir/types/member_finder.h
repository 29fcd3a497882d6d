// Members of a type by name, for whoever asks for many. Two versions mostly declare
// their members in the same order, so the member after the last one found is tried
// before a table is made.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>

#include "ir/types/types.h"

namespace ir {

class MemberFinder {
 public:
  // `type` may be invalid: then nothing is found.
  MemberFinder(const TypeTable& types, TypeId type);
  std::optional<size_t> find(const std::string& name);

 private:
  const std::vector<Member>* members_ = nullptr;
  size_t next_ = 0;
  std::unordered_map<std::string, size_t> numbers_;  // by folded name; made when needed
};

}  // namespace ir
