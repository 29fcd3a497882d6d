#include "frontend/parse/tree.h"

namespace frontend {

const Attribute* Tree::find_attribute(Range32 of, std::string_view name) const {
  for (uint32_t i = 0; i < of.count; ++i) {
    const Attribute& attribute = attributes[of.first + i];
    if (ir::same_name(attribute.name.text, name)) return &attribute;
  }
  return nullptr;
}

}  // namespace frontend
