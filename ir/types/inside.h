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

// The name of a reference's target: the path of its area ("" for the globals) and where inside.
// "ref" where there is no variable to name.
std::string reference_text(const std::string& area, std::string inside);

// Offsets of all 4-byte slots (instance IDs, in-outs) in an area of type `root`, sorted.
// `types` is verified; the cost is that of all elements that hold slots.
std::vector<uint32_t> slots_inside(const TypeTable& types, const Layouts& layouts, TypeId root);

}  // namespace ir
