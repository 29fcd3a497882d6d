// X2: what the sources moved between the variables of one area: into a structure, out of one, from
// one to another; `{renamed from := 'limit.low'}` before a variable, `{renamed '.low' from :=
// 'low'}` before one with parts (docs/adr/0012-renames.md). Such a rule pairs places, not names, so
// it is not applied to the old image (ir/bytecode/renames.h) but where the two areas are compared.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "ir/bytecode/image.h"

namespace online_change {

struct PartPlace {
  std::string path;  // ".limit.low", ".row[3]"; in the names of the image
  uint32_t at = 0;   // in the area
  ir::TypeId type;
};
struct MovedPart {
  PartPlace from;       // in the old version
  PartPlace to;         // in the new one
  bool leaves = false;  // the new version has nothing at the old place's path
};

// Rules are those of the new version. One applies where the old version has a value at one of its
// old names, the latest first, that A14 can carry over, and none at the new place. Nothing in
// unions, other instances and constants is moved, and nothing that holds instances.
std::vector<MovedPart> moved_parts(const ir::Image& old_image, ir::TypeId old_area,
                                   const ir::Image& new_image, ir::TypeId new_area);

// Does `row`, the path of a fate row with ranges of indices, speak of what `path` is or is part of?
bool covers(const std::string& row, const std::string& path);

}  // namespace online_change
