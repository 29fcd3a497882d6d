// Where things are inside a type: size, alignment, member offsets. A Layouts
// table belongs to one image. Offsets of members that live on are the same in
// the next version's table (A1, A4; linker/layout.h computes it), so a layout is
// data, never recomputed from the type alone.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/types/types.h"

namespace ir {

struct TypeLayout {
  uint32_t size = 0;  // bytes of a value embedded in something (instances: 4, the ID slot)
  uint32_t align = 1;
  // For types with members:
  std::vector<uint32_t> member_offsets;  // parallel to Type::members
  uint32_t used = 0;                     // bytes of the members' area, holes included
  // For instances and globals: size of each area, used plus slack (A5, A6).
  uint32_t area_capacity = 0;
};

struct Layouts {
  std::vector<TypeLayout> of;  // by TypeId index
  const TypeLayout& operator[](TypeId id) const { return of[id.index]; }
};

// Is it the same type in both versions, including the layout of everything embedded:
// a value can stay where it is, byte for byte.
bool same_value_type(const TypeTable& old_types, const Layouts& old_layouts, TypeId old_type,
                     const TypeTable& new_types, const Layouts& new_layouts, TypeId new_type);

}  // namespace ir
