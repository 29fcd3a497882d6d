#include "ir/types/location.h"

#include <algorithm>

namespace ir {

bool is_locatable(const TypeTable& types, TypeId type) {
  while (types[type].kind == Kind::kArray) type = types[type].base;
  if (is_structure(types[type].kind)) {
    const std::vector<Member>& members = types[type].members;
    return std::all_of(members.begin(), members.end(),
                       [&types](const Member& member) { return is_locatable(types, member.type); });
  }
  return types.is_scalar(type) && !types.is_reference(type);
}

uint64_t located_bools(const TypeTable& types, TypeId type, const DirectAddress& address) {
  uint64_t count = 1;
  while (types[type].kind == Kind::kArray) {
    for (const Dimension& dim : types[type].dims) count *= dim.count();
    type = types[type].base;
  }
  if (!types.is_scalar(type) || types.scalar(type) != Scalar::kBool) return 0;
  return count == 1 || address.bit_size == 1 ? count : 0;
}

uint64_t located_bits(const TypeTable& types, const Layouts& natural, TypeId type,
                      const DirectAddress& address) {
  uint64_t bools = located_bools(types, type, address);
  return bools != 0 ? bools : uint64_t{natural[type].size} * 8;
}

}  // namespace ir
