#include "ir/bytecode/located_paths.h"

#include <unordered_set>

#include "ir/bytecode/symbols.h"
#include "ir/types/shared_bytes.h"

namespace ir {

namespace {

// Where the variables lie that have their address by declaration: in data memory.
std::unordered_set<uint32_t> declared_places(const Image& image) {
  std::unordered_set<uint32_t> declared;
  for (const Instance& row : image.instances) {
    if (!row.live) continue;
    const std::vector<Member>& members = image.types[row.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      const uint32_t at = row.data + image.layouts[row.type].member_offsets[i];
      const DirectAddress& address = members[i].address;
      if (address.area == DirectArea::kNone || address.bit_offset == kOpenAddress) continue;
      declared.insert(at);
      if (!is_shared(image.types, members[i])) continue;
      for (const uint32_t part : image.layouts[members[i].type].member_offsets) {
        declared.insert(at + part);
      }
    }
  }
  return declared;
}

}  // namespace

std::vector<LocatedPath> located_paths(const Image& image) {
  const std::unordered_set<uint32_t> declared = declared_places(image);
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
