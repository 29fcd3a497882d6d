#include "ir/bytecode/located_paths.h"

#include <unordered_set>

#include "ir/bytecode/symbols.h"

namespace ir {

std::vector<LocatedPath> located_paths(const Image& image) {
  std::unordered_set<uint32_t> declared;
  for (const Instance& row : image.instances) {
    if (!row.live) continue;
    const std::vector<Member>& members = image.types[row.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      const DirectAddress& address = members[i].address;
      const bool own = address.area != DirectArea::kNone && address.bit_offset != kOpenAddress;
      if (own) declared.insert(row.data + image.layouts[row.type].member_offsets[i]);
    }
  }
  std::vector<LocatedPath> located;
  for (const IoBinding& row : image.io) {
    if (declared.contains(row.data)) continue;
    Symbol symbol;
    symbol.data = row.data;
    symbol.type = row.type;
    located.push_back({path_of(image, symbol), row.address});
  }
  return located;
}

}  // namespace ir
