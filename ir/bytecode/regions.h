// What lies at an offset inside a region: the one lookup behind the verifier,
// symbols, planning and monitoring.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "ir/bytecode/code.h"
#include "ir/types/layout.h"

namespace ir {

// Bytes of a region.
uint32_t region_size(const TypeTable& types, const Layouts& layouts, Region region);

enum class LeafKind : uint8_t { kScalar, kStringByte, kInstanceSlot, kInOutSlot };
struct Leaf {
  LeafKind kind = LeafKind::kScalar;
  TypeId type;            // of the scalar, of the slot's instance, of the in-out's target
  uint32_t begin = 0;     // offset of the leaf in the region
  bool constant = false;  // some member on the way is CONSTANT
  bool input = false;     // some member on the way is a %I variable
  bool output = false;    // some member on the way is a %Q variable
};
// A test of leaves, borrowed for one call; empty: every leaf will do.
class LeafTest {
 public:
  LeafTest() = default;
  template <class Test>
  LeafTest(const Test& test)  // NOLINT: lambdas are passed as they are
      : test_(&test), call_([](const void* t, const Leaf& leaf) {
          return (*static_cast<const Test*>(t))(leaf);
        }) {}
  bool operator()(const Leaf& leaf) const { return call_ == nullptr || call_(test_, leaf); }

 private:
  const void* test_ = nullptr;
  bool (*call_)(const void*, const Leaf&) = nullptr;
};
// The leaf that covers `offset`; nullopt in padding, holes and beyond the end. In a union the
// first of its members that covers it.
std::optional<Leaf> leaf_at(const TypeTable& types, const Layouts& layouts, Region region,
                            uint32_t offset);
// Is there a value of exactly `wanted` at `offset`? Strings: capacity at least wanted's.
bool has_region_at(const TypeTable& types, const Layouts& layouts, Region region, uint32_t offset,
                   Region wanted);

// What indexing the next dimension of the array region `from` leads to: `from` with
// dim + 1, or the element. The element of an array of instances is an ID slot, not an
// area: it stays {array, number of dimensions}.
Region indexed_region(const TypeTable& types, Region from);
// Bytes from one index to the next in the first open dimension of `from`.
uint64_t index_stride(const TypeTable& types, const Layouts& layouts, Region from);

// How a place may be used, from the members on the way to it.
struct PlaceFlags {
  bool constant = false;
  bool input = false;
  bool output = false;
};

// A scalar that alone has its bytes: a type by itself (at offset 0), or a member of its own.
struct ScalarPlace {
  uint32_t offset = 0;
  Class cls = Class::kB;
  PlaceFlags flags;
};

// The same lookups with an index over the members, for whoever does many: a lookup costs
// O(log members) per level. Borrows both tables, which must be consistent (verify.h).
class RegionMap {
 public:
  RegionMap(const TypeTable& types, const Layouts& layouts);

  uint32_t size(Region region) const { return region_size(types_, layouts_, region); }
  // What is a scalar by itself in that type, by offset. Not all where members overlap.
  std::span<const ScalarPlace> scalars(TypeId type) const {
    const uint32_t first = first_scalar_[type.index];
    return std::span(scalars_).subspan(first, first_scalar_[type.index + 1] - first);
  }
  // Most of what code names, without going down: null says nothing.
  const ScalarPlace* scalar_at(Region region, uint32_t offset) const;
  // The first one that `accept` takes, where several lie on top of each other.
  std::optional<Leaf> leaf_at(Region region, uint32_t offset,
                              const LeafTest& accept = LeafTest()) const;
  // As has_region_at, with what the way to the place allows.
  std::optional<PlaceFlags> find(Region region, uint32_t offset, Region wanted) const;
  // Do both name the same kind of place? Strings: `have` holds at least `wanted`'s capacity.
  bool same(Region have, Region wanted) const;

 private:
  const TypeTable& types_;
  const Layouts& layouts_;
  void add_members(TypeId type);
  void add_ends(TypeId type);
  std::vector<uint32_t> first_member_;  // by type, in `order_`
  std::vector<uint32_t> order_;         // of each type: members by offset
  std::vector<uint32_t> first_scalar_;  // by type, in `scalars_`
  std::vector<ScalarPlace> scalars_;    // of each type, by offset
  // For types whose members overlap: a tree over the ends of their members by offset.
  std::unordered_map<TypeId, std::vector<uint32_t>> ends_;
};

}  // namespace ir
