// Looks things up among the declarations.
#include "frontend/sema/declarations.h"

namespace frontend {

const PouInfo* Declarations::pou_of(ir::TypeId instance) const {
  const auto found = pou_by_type.find(instance);
  return found == pou_by_type.end() ? nullptr : &pous[found->second];
}

const PouInfo* Declarations::find_pou(std::string_view qualified) const {
  const auto found = pou_names.find(qualified);
  return found == pou_names.end() ? nullptr : &pous[found->second];
}

uint32_t Declarations::block_of(uint32_t pou) const {
  if (pou == kNoPou) return kNoPou;
  const PouInfo& info = pous[pou];
  if (info.owner != kNoPou) return info.owner;
  return info.self.valid() ? pou : kNoPou;
}

const StructureField* Declarations::find_field(ir::TypeId structure, std::string_view name) const {
  const auto table = structures.find(structure);
  if (table == structures.end()) return nullptr;
  const auto found = table->second.find(name);
  return found == table->second.end() ? nullptr : &found->second;
}

int32_t Declarations::find_member(ir::TypeId structure, std::string_view name) const {
  const StructureField* field = find_field(structure, name);
  return field == nullptr || field->bit >= 0 ? -1 : static_cast<int32_t>(field->member);
}

int32_t Declarations::find_literal(ir::TypeId enumeration, std::string_view name) const {
  const auto table = enumerations.find(enumeration);
  if (table == enumerations.end()) return -1;
  const auto found = table->second.find(name);
  return found == table->second.end() ? -1 : static_cast<int32_t>(found->second);
}

const ir::EnumLiteral* Declarations::forming_literal(std::string_view name,
                                                     ir::TypeId* base) const {
  if (forming.empty()) return nullptr;
  for (const ir::EnumLiteral& literal : *forming.back().literals) {
    if (!ir::same_name(literal.name, name)) continue;
    *base = forming.back().base;
    return &literal;
  }
  return nullptr;
}

const OpenArray* Declarations::open_array(ir::TypeId type) const {
  const auto found = open_arrays.find(type);
  return found == open_arrays.end() ? nullptr : &found->second;
}

std::string_view Declarations::keep_name(std::string name) {
  return made_names.emplace_back(std::move(name));
}

}  // namespace frontend
