// What a change keeps of a union (case 74).
#pragma once

#include <cstdint>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

// A member that is in both versions of a union, by its number in each.
struct UnionView {
  uint32_t old_member;
  uint32_t new_member;
  bool same;  // of one type and at one place
};
std::vector<UnionView> union_views(const ir::Image& old_image, ir::TypeId old_type,
                                   const ir::Image& new_image, ir::TypeId new_type);

// Members that both have, each of one type and at one place, say what the bytes of both are. Others
// of the same name with another type are views of such bytes, in both versions; but not structures:
// their members would read the bytes of each other.
bool keeps_union_bytes(const ir::Image& old_image, ir::TypeId old_type, const ir::Image& new_image,
                       ir::TypeId new_type);

}  // namespace online_change
