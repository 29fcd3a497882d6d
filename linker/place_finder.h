// Byte offsets -> symbolic places: the other way round than offsets.h. Where the source of code is
// not at hand, an image says by its types and layouts what its code names (linker/unlink.h).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ir/bytecode/code.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"

namespace linker {

// A place on the way down. `area`: the variables of an instance or of the globals, not an ID slot.
struct Spot {
  ir::Region region;
  uint32_t offset = 0;  // what is left of the offset inside it
  bool area = false;
  bool in_out = false;  // the slot of an in-out of region.type
};
// Is it what is looked for? Asked of the outermost place first.
using SpotTest = std::function<bool(const Spot&)>;

struct FoundPlace {
  ir::Steps steps;
  ir::Region result;
  bool overlaid = false;  // others lie on top of it, so it is one of several answers
};

// Borrows the image. A lookup costs O(log members) a level.
class PlaceFinder {
 public:
  explicit PlaceFinder(const ir::Image& image);

  // What `wanted` takes at `offset` of a region; nullopt: nothing.
  std::optional<FoundPlace> find(ir::Region root, uint32_t offset, const SpotTest& wanted) const;

  // What there is to look for.
  SpotTest scalar(ir::Class cls) const;
  SpotTest region(ir::Region wanted) const;
  SpotTest string(ir::Class cls, uint32_t capacity) const;
  SpotTest in_out_slot() const;
  SpotTest instance_slot() const;
  static bool anything(const Spot& spot) { return spot.offset == 0; }

  // Some type whose variables have that size; nullopt: none.
  std::optional<ir::TypeId> type_of_size(uint32_t size) const;

 private:
  bool go_down(Spot spot, const SpotTest& wanted, uint32_t& budget, FoundPlace& found) const;
  bool enter_element(Spot& spot, FoundPlace& found) const;
  // Calls `each` with the members that cover the offset, until it is true.
  bool try_members(const Spot& spot, const std::function<bool(size_t)>& each) const;
  uint32_t size_of(const ir::Member& member) const;

  const ir::Image& image_;
  std::vector<std::vector<uint32_t>> by_offset_;  // of each type: members that do not overlap
};

}  // namespace linker
