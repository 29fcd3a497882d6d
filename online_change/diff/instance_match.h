// Which instance of the new version is which of the old one: by path, walked from
// the programs and globals down (invariant 7). IDs and places play no part, except
// that the same ID under the same name is found first.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

inline constexpr uint32_t kNoInstance = 0xffffffffu;

struct InstanceMatch {
  // By ID; kNoInstance: free ID, or no counterpart of the same path and type.
  std::vector<uint32_t> old_of_new;
  std::vector<uint32_t> new_of_old;
  // Live IDs, parents before children; row 0 first.
  std::vector<uint32_t> new_order;
  std::vector<uint32_t> old_order;
  // The path lives on with another type (TON -> TOF): by new ID, the old instance.
  std::vector<uint32_t> retyped_from;
};

// An instance's name without the index that it has in an array.
inline std::string_view base_name(std::string_view name) { return name.substr(0, name.find('[')); }

InstanceMatch match_instances(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
