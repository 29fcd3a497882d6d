#include "ir/bytecode/located_layouts.h"

#include <vector>

#include "ir/types/natural_layout.h"

namespace ir {

Layouts located_layouts(const Image& image) {
  std::vector<TypeId> wanted;
  for (const IoBinding& row : image.io) {
    if (!image.types.contains(row.type)) continue;  // of an image that is not verified yet
    if (wanted.empty() || wanted.back() != row.type) wanted.push_back(row.type);
  }
  return natural_layouts(image.types, wanted);
}

}  // namespace ir
