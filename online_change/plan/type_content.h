// What a type is, as one text: two types with the same name can differ inside, a structure by its
// members, an enumeration by its values. Blocks are told by name alone: what they hold is theirs.
#pragma once

#include <string>
#include <vector>

#include "ir/types/types.h"

namespace online_change {

class TypeContent {
 public:
  // Borrows the types.
  explicit TypeContent(const ir::TypeTable& types) : types_(types) {}
  std::string of(ir::TypeId id);

 private:
  void append(ir::TypeId id, std::string& out);

  const ir::TypeTable& types_;
  std::vector<ir::TypeId> seen_;
};

}  // namespace online_change
