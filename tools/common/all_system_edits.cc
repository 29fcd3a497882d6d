#include "tools/common/all_system_edits.h"

#include <map>
#include <string>
#include <utility>

#include "ir/bytecode/renames.h"
#include "ir/types/address_text.h"
#include "vm/load/left_outputs.h"

namespace tools {
namespace {

// E-01: POUs and sections that are parts of another unit of an edit than before.
void add_unit_edits(const ir::Image& old_image, const ir::Image& new_image, SystemEdits& edits) {
  std::map<std::string, std::pair<std::string, std::string>> units;  // old and new, by member
  for (const ir::UnitMember& row : old_image.unit_members) units[row.name].first = row.unit;
  for (const ir::UnitMember& row : new_image.unit_members) units[row.name].second = row.unit;
  for (const auto& [name, unit] : units) {
    if (ir::same_name(unit.first, unit.second)) continue;
    const auto shown = [](const std::string& text) { return text.empty() ? "of its own" : text; };
    edits.push_back({"unit", name, shown(unit.first) + " -> " + shown(unit.second)});
  }
}

}  // namespace

SystemEdits all_system_edits(const ir::VerifiedImage& old_version,
                             const ir::VerifiedImage& new_version, bool back) {
  const ir::Image& old_image = old_version.image();
  const ir::Image& new_image = new_version.image();
  const ir::OldUnderNewNames names(back ? new_image : old_image, back ? old_image : new_image);
  const ir::Image& before = back ? old_image : names.image();
  const ir::Image& after = back ? names.image() : new_image;
  SystemEdits edits = online_change::system_edits(before, after);
  for (const vm::LeftOutput& output : vm::left_outputs({before, old_version.running_pous()},
                                                       {after, new_version.running_pous()})) {
    edits.push_back({"output", ir::address_text(output.address),
                     "`" + output.path + "` is no longer written by any code"});
  }
  add_unit_edits(before, after, edits);
  for (auto& edit : edits) {
    if (!back || edit.kind != "variable") continue;
    std::string own = ir::own_path(new_image, after, edit.name);
    if (!own.empty()) edit.name = std::move(own);
  }
  return edits;
}

}  // namespace tools
