#include "tools/stc/unit_settings.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "base/joined.h"
#include "base/name_case.h"
#include "base/nearest_name.h"
#include "ir/bytecode/part_edits.h"

namespace stc {
namespace {

base::Error wrong_at(const std::string& file, tools::TomlPlace place, std::string what) {
  return tools::toml_error(file, place.line, place.column, std::move(what));
}

// POUs as people write them, and sections.
struct UnitNames {
  std::set<std::string> folded;
  std::vector<std::string> written;
  std::set<std::string> methods;  // of blocks: no sections

  void add(const std::string& name) {
    if (folded.insert(ir::fold_name(name)).second) written.push_back(name);
  }
};

UnitNames names_in(std::span<const ir::Image* const> programs) {
  UnitNames names;
  for (const ir::Image* const image : programs) {
    for (uint32_t i = 0; i < image->pous.size(); ++i) {
      const ir::LinkedPou& pou = image->pous[i];
      if (ir::unit_name(*image, i, {}).empty()) continue;
      const bool member = pou.kind == ir::PouKind::kMethod;
      if (member && (*image->types)[pou.self].kind != ir::Kind::kProgram) {
        names.methods.insert(ir::fold_name(pou.name));
      } else {
        names.add(pou.name);
      }
    }
  }
  return names;
}

std::string unknown_name(const UnitNames& names, const std::string& name) {
  if (names.methods.contains(ir::fold_name(name))) {
    return base::joined(
        {"`", name, "` goes with its block; only actions of a PROGRAM are sections"});
  }
  base::NearestName nearest(name);
  for (const std::string& known : names.written) nearest.offer(known);
  return base::joined({"there is no POU and no action `", name, "`", nearest.question()});
}

}  // namespace

ir::UnitMembers UnitSettings::members() const {
  ir::UnitMembers members;
  for (const Entry& entry : entries) members.push_back({entry.name, entry.unit});
  ir::sort_by_name(members);
  return members;
}

base::Result<UnitSettings> parse_unit_settings(const tools::ProjectFile& file) {
  UnitSettings settings{file.path, {}};
  std::map<std::string, std::string> unit_of;
  std::map<std::string, std::string> units;
  for (const auto& [key, value] : file.table) {
    if (!key.starts_with(tools::kUnitTable)) continue;
    const std::string unit = key.substr(tools::kUnitTable.size());
    const tools::TomlPlace of_key{value.line, value.column};
    const auto* const names = std::get_if<std::vector<std::string>>(&value.data);
    if (names == nullptr || names->empty()) {
      return wrong_at(file.path, value.place,
                      base::joined({"unit `", unit, "` must be a list of names of POUs"}));
    }
    if (ir::same_name(unit, ir::kTableName)) {
      return wrong_at(file.path, of_key,
                      base::joined({"a unit cannot be called `", unit,
                                    "`: that is all of an edit that is no unit"}));
    }
    if (const auto [other, added] = units.emplace(ir::fold_name(unit), unit); !added) {
      return wrong_at(
          file.path, of_key,
          base::joined({"unit `", unit, "` is there already, as `", other->second, "`"}));
    }
    for (size_t i = 0; i < names->size(); ++i) {
      const std::string& name = (*names)[i];
      const auto [other, added] = unit_of.emplace(ir::fold_name(name), unit);
      if (!added) {
        return wrong_at(file.path, value.places[i],
                        base::joined({"`", name, "` is in unit `", other->second, "` already"}));
      }
      settings.entries.push_back({name, unit, value.places[i]});
    }
  }
  return settings;
}

base::Status check_unit_settings(const UnitSettings& settings,
                                 std::span<const ir::Image* const> programs) {
  if (settings.entries.empty()) return base::Ok{};
  const UnitNames names = names_in(programs);
  std::set<std::string> members;
  for (const UnitSettings::Entry& entry : settings.entries) {
    members.insert(ir::fold_name(entry.name));
    if (names.folded.contains(ir::fold_name(entry.name))) continue;
    return wrong_at(settings.file, entry.place, unknown_name(names, entry.name));
  }
  // Else what stands apart would go with it.
  for (const UnitSettings::Entry& entry : settings.entries) {
    const std::string unit = ir::fold_name(entry.unit);
    if (!names.folded.contains(unit) || members.contains(unit)) continue;
    return wrong_at(settings.file, entry.place,
                    base::joined({"unit `", entry.unit,
                                  "` has the name of a POU that is in no unit"
                                  "; put it into this one, or call the unit otherwise"}));
  }
  return base::Ok{};
}

}  // namespace stc
