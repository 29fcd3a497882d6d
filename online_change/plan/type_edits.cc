#include "online_change/plan/type_edits.h"

#include <map>

#include "base/check.h"

namespace online_change {
namespace {

std::string number(int64_t value) { return std::to_string(value) + ";"; }

// What the declaration says, without what the types that it names say.
std::string declaration(const ir::TypeTable& types, const ir::Type& type) {
  std::string out = number(static_cast<int64_t>(type.kind)) + number(type.low) + number(type.high) +
                    number(type.capacity) + number(type.overlap ? 1 : 0);
  if (type.base.valid()) out += types.text(type.base) + ";";
  for (const ir::Dimension& dim : type.dims) out += number(dim.low) + number(dim.high);
  for (const ir::EnumLiteral& literal : type.literals) {
    out += ir::fold_name(literal.name) + "=" + number(literal.value);
  }
  for (const ir::Member& member : type.members) {
    out += ir::fold_name(member.name) + ":" + types.text(member.type) + ";";
  }
  return out;
}

std::map<std::string, const ir::Type*> named_types(const ir::TypeTable& types) {
  std::map<std::string, const ir::Type*> out;
  for (uint32_t i = ir::kElementaryCount; i < types.size(); ++i) {
    const ir::TypeId id(i);
    const ir::Type& type = types[id];
    const bool other = types.is_instance(id) || type.kind == ir::Kind::kGlobals;
    if (!type.name.empty() && !other) out.emplace(ir::fold_name(type.name), &type);
  }
  return out;
}

}  // namespace

const char* type_change_name(TypeChange change) {
  switch (change) {
    case TypeChange::kAdded:
      return "added";
    case TypeChange::kRemoved:
      return "removed";
    case TypeChange::kEdited:
      return "edited";
  }
  base::check(false, "a change that type_change_name() knows");
  return "";
}

std::vector<TypeEdit> type_edits(const EncodedImage& old_version, const EncodedImage& new_version) {
  std::vector<TypeEdit> edits;
  if (same_types(old_version, new_version)) return edits;
  const ir::TypeTable& old_types = old_version.image.types;
  const ir::TypeTable& new_types = new_version.image.types;
  const auto before = named_types(old_types);
  const auto after = named_types(new_types);
  for (const auto& [name, type] : after) {
    const auto found = before.find(name);
    if (found == before.end()) {
      edits.push_back({TypeChange::kAdded, type->name});
    } else if (declaration(old_types, *found->second) != declaration(new_types, *type)) {
      edits.push_back({TypeChange::kEdited, type->name});
    }
  }
  for (const auto& [name, type] : before) {
    if (!after.contains(name)) edits.push_back({TypeChange::kRemoved, type->name});
  }
  return edits;
}

}  // namespace online_change
