// Where the variables of the old version are in the new one, as references to them need it: a
// handle names an area and an offset in it (ir/types/handle.h), and both can be others after a
// change. One table per pair of types, made beforehand from the two images; follow() allocates
// nothing and goes as deep as types are nested. Variables meet by name, elements by index, as in
// type_diff.h.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "ir/bytecode/image.h"
#include "ir/types/reach.h"

namespace online_change {

// What a reference is declared to lead to. Types of both versions are one when their texts are.
struct Target {
  uint32_t name = 0;
  bool instance = false;  // a function block, class or interface
};

struct Followed {
  uint64_t handle = 0;
  bool gone = false;  // what it named has no place in the new version
};

class PlaceMoves {
 public:
  // The version whose rules say what was moved between variables (moved_parts.h): kBack when the
  // old image is the one that is changed to, on the way back from it.
  enum class Way : uint8_t { kThere, kBack };
  // Everything stays.
  PlaceMoves() = default;
  // Borrows nothing.
  PlaceMoves(const ir::Image& old_image, const ir::Image& new_image, Way way = Way::kThere);

  // Does every handle mean the same in both versions?
  bool trivial() const { return trivial_; }
  // What names in the new version what `handle` named in the old one. A handle that named nothing
  // stays as it is: nothing else gets its segment. One that has left its variable follows that, and
  // keeps the distance from its end, or from its beginning when it lies before that.
  Followed follow(uint64_t handle, Target target) const;
  Target target_in_old(const ir::Image& image, ir::TypeId reference) const;
  Target target_in_new(const ir::Image& image, ir::TypeId reference) const;

 private:
  enum class Kind : uint8_t { kLeaf, kArray, kStructure };
  struct Bounds {
    int64_t old_low = 0;
    int64_t new_low = 0;
    uint64_t old_count = 0;
    uint64_t new_count = 0;
  };
  struct Part {  // of the old structure, by offset
    uint32_t begin = 0;
    uint32_t size = 0;
    uint32_t to = 0;
    uint32_t pair = kNone;  // kNone: gone
    ir::Reach reach;        // of an area: of the new variable that `to` lies in
  };
  struct Pair {
    Kind kind = Kind::kLeaf;
    bool same = false;  // all in it has the place and the meaning that it had
    bool kept = false;  // kLeaf: a reference still finds what it is for
    uint32_t old_name = 0;
    uint32_t new_name = 0;
    uint32_t old_size = 0;
    uint32_t new_size = 0;
    uint32_t element = kNone;       // kArray
    std::vector<Bounds> dims;       // kArray
    std::vector<Part> parts;        // kStructure
    std::vector<Part> moved;        // of an area: to another place than `parts` say; not sorted
    std::vector<uint32_t> no_more;  // of an area: names of bases and interfaces that it has lost
  };
  struct Area {
    uint32_t old_segment = 0;  // 0: not live
    uint32_t new_segment = 0;  // 0: gone
    uint32_t pair = kNone;
  };
  static constexpr uint32_t kNone = 0xffffffffu;

  class Maker;
  static Followed walked(uint64_t offset, uint32_t segment) {
    return {uint64_t{segment} << 32 | offset, false};
  }
  // The element's number in the new array; nullopt-like: false when it has none.
  static bool element_of(const Pair& array, uint64_t number, uint64_t& out);
  const Part* part_at(const Pair& structure, uint32_t offset) const;
  static const Part* moved_at(const Pair& area, uint32_t offset);
  Followed follow_outside(const Area& area, uint64_t handle) const;
  const Part* variable_at(const Pair& area, uint32_t offset) const;
  bool reads_alike(uint32_t pair) const;

  std::vector<Pair> pairs_;
  std::vector<Area> areas_;  // by old ID
  std::vector<uint32_t> old_names_;
  std::vector<uint32_t> new_names_;
  bool trivial_ = true;
};

}  // namespace online_change
