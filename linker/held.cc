#include "linker/held.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "base/name_case.h"

namespace linker {
namespace {

// What a source writes last of it: "Limit" of `Settings.Limit`.
uint32_t last_word(const std::string& name) {
  const std::string folded = base::fold_name(name);
  const size_t dot = folded.rfind('.');
  return ir::word_hash(std::string_view(folded).substr(dot == std::string::npos ? 0 : dot + 1));
}

bool has_held_values(const ir::Type& type) {
  switch (type.kind) {
    case ir::Kind::kFunctionBlock:  // its values are in data, and its members have names in code
    case ir::Kind::kProgram:
    case ir::Kind::kGlobals:
    case ir::Kind::kInterface:
      return false;
    default:
      return !type.name.empty();
  }
}

}  // namespace

HeldNames::HeldNames(const ir::Program& program) {
  for (const ir::Member& member : program.types[program.globals].members) {
    if (!member.constant) continue;
    by_word_.emplace(last_word(member.name), ir::HeldName{ir::HeldKind::kGlobal, member.name});
  }
  for (uint32_t i = ir::kElementaryCount; i < program.types.size(); ++i) {
    const ir::Type& type = program.types[ir::TypeId(i)];
    if (!has_held_values(type)) continue;
    const ir::HeldName held{ir::HeldKind::kType, type.name};
    by_word_.emplace(last_word(type.name), held);
    for (const ir::EnumLiteral& literal : type.literals) {
      by_word_.emplace(last_word(literal.name), held);
    }
  }
}

std::vector<ir::HeldName> HeldNames::of(const ir::Object& object) const {
  std::vector<ir::HeldName> names = object.held;
  for (const std::string& function : object.taken_in) {
    names.push_back({ir::HeldKind::kFunction, function});
  }
  for (const uint32_t word : object.content.words) {
    const auto [first, last] = by_word_.equal_range(word);
    for (auto row = first; row != last; ++row) names.push_back(row->second);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::vector<ir::HeldPart> held_parts(const std::vector<const ir::Object*>& objects,
                                     const HeldNames& names) {
  std::vector<ir::HeldPart> rows;
  for (uint32_t pou = 0; pou < objects.size(); ++pou) {
    if (objects[pou] == nullptr) continue;
    for (ir::HeldName& name : names.of(*objects[pou])) rows.push_back({pou, std::move(name)});
  }
  return rows;
}

}  // namespace linker
