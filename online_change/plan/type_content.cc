#include "online_change/plan/type_content.h"

#include <algorithm>

namespace online_change {

std::string TypeContent::of(ir::TypeId id) {
  std::string out = types_.text(id);
  append(id, out);
  seen_.clear();
  return out;
}

void TypeContent::append(ir::TypeId id, std::string& out) {
  const ir::Type& type = types_[id];
  if (ir::is_reference(type.kind) || types_.is_instance(id)) return;
  if (type.kind == ir::Kind::kArray) return append(type.base, out);
  if (std::find(seen_.begin(), seen_.end(), id) != seen_.end()) return;
  seen_.push_back(id);
  for (const ir::EnumLiteral& literal : type.literals) {
    out += "," + ir::fold_name(literal.name) + "=" + std::to_string(literal.value);
  }
  if (!ir::is_structure(type.kind)) return;
  out += "{";
  for (const ir::Member& member : type.members) {
    out += ir::fold_name(member.name) + ":" + types_.text(member.type);
    append(member.type, out);
    out += ";";
  }
  out += "}";
}

}  // namespace online_change
