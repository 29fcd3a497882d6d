// What the code of POUs holds although no name in it says so (ir::HeldName).
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"

namespace linker {

// The constants and declared types of a program, by the words that name them in sources. A word can
// stand for something else in one POU, so it may hold less than this says, and never more.
class HeldNames {
 public:
  HeldNames() = default;
  explicit HeldNames(const ir::Program& program);
  // Sorted, none twice.
  std::vector<ir::HeldName> of(const ir::Object& object) const;

 private:
  std::unordered_multimap<uint32_t, ir::HeldName> by_word_;
};

// Rows of Image::held for `objects`, by POU number; null: no rows.
std::vector<ir::HeldPart> held_parts(const std::vector<const ir::Object*>& objects,
                                     const HeldNames& names);

}  // namespace linker
