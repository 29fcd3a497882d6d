// What lies at an offset inside a region: the one lookup behind the verifier,
// symbols, planning and monitoring.
#pragma once

#include <cstdint>
#include <optional>

#include "ir/bytecode/code.h"
#include "ir/types/layout.h"

namespace ir {

// Bytes of a region.
uint32_t region_size(const TypeTable& types, const Layouts& layouts, Region region);

enum class LeafKind : uint8_t { kScalar, kStringByte, kInstanceSlot, kInOutSlot };
struct Leaf {
  LeafKind kind = LeafKind::kScalar;
  TypeId type;               // of the scalar, of the slot's instance, of the in-out's target
  uint32_t begin = 0;        // offset of the leaf in the region
  bool constant = false;     // some member on the way is CONSTANT
  bool input = false;        // some member on the way is a %I variable
  bool output = false;       // some member on the way is a %Q variable
};
// The leaf that covers `offset`; nullopt in padding, holes and beyond the end.
std::optional<Leaf> leaf_at(const TypeTable& types, const Layouts& layouts, Region region,
                            uint32_t offset);
// Is there a value of exactly `wanted` at `offset`? Strings: capacity at least wanted's.
bool has_region_at(const TypeTable& types, const Layouts& layouts, Region region, uint32_t offset,
                   Region wanted);

}  // namespace ir
