#include "frontend/parse/tree.h"

namespace frontend {

const Attribute* Tree::find_attribute(Range32 of, std::string_view name) const {
  for (uint32_t i = 0; i < of.count; ++i) {
    const Attribute& attribute = attributes[of.first + i];
    if (ir::same_name(attribute.name.text, name)) return &attribute;
  }
  return nullptr;
}

uint32_t Tree::add_name(const Name& name) {
  names.push_back(name);
  return static_cast<uint32_t>(names.size() - 1);
}

}  // namespace frontend
