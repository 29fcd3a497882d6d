// What lies at an offset inside a value or an area, for references: names for people, and where
// the slots are that no reference may touch.
#pragma once

#include <string>
#include <vector>

#include "ir/types/layout.h"

namespace ir {

// "[1,-2]": element number `flat` of an array.
std::string index_text(const Type& array, uint64_t flat);

// The place `offset` bytes into a value of type `root` (an instance: its area), as a path from
// there: ".a[2].b", "[3]", "" for the whole. It ends at a part of type `target` that begins there,
// otherwise at the smallest part, with "+2" for bytes into it. Total: any offset has a name.
std::string path_inside(const TypeTable& types, const Layouts& layouts, TypeId root,
                        uint32_t offset, TypeId target);

// The place that a handle names in its area, of type `area`: as path_inside() for one that is
// inside of its variable; otherwise the variable and the distance from its beginning, ".a+40" or
// ".a-4".
std::string handle_text(const TypeTable& types, const Layouts& layouts, TypeId area,
                        uint64_t handle, TypeId target);

// Why a handle that has left its variable traps. `area`: invalid for locals, which have no names.
std::string left_text(const TypeTable& types, const Layouts& layouts, TypeId area, uint64_t handle);

// The name of a reference's target: the path of its area ("" for the globals) and where inside.
// "ref" where there is no variable to name.
std::string reference_text(const std::string& area, std::string inside);

// Offsets of all 4-byte slots (instance IDs, in-outs) in areas, sorted. `types` is verified, and
// borrowed; the cost is that of all elements that hold slots, and once that of all types.
class SlotFinder {
 public:
  SlotFinder(const TypeTable& types, const Layouts& layouts)
      : types_(types), layouts_(layouts), holds_(types.size(), Holds::kUnknown) {}
  std::vector<uint32_t> inside(TypeId root);

 private:
  enum class Holds : uint8_t { kUnknown, kNo, kYes };
  void members(TypeId id, uint32_t begin, uint32_t depth);
  void value(TypeId id, uint32_t at, uint32_t depth);
  void elements(TypeId id, uint32_t at, uint32_t depth);
  bool holds(TypeId id, uint32_t depth);

  const TypeTable& types_;
  const Layouts& layouts_;
  std::vector<Holds> holds_;  // by type
  std::vector<uint32_t> slots_;
};

}  // namespace ir
