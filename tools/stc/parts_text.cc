#include "tools/stc/parts_text.h"

#include <map>
#include <set>

#include "base/visible_text.h"
#include "ir/bytecode/identities.h"
#include "tools/common/fleet_parts.h"
#include "tools/common/table.h"

namespace stc {

std::string parts_text(const ir::Image& image) {
  std::map<std::string, std::set<std::string>> held;
  for (const ir::HeldPart& row : image.held) {
    const std::string unit = ir::unit_name(image, row.pou);
    if (!unit.empty() && unit != row.what.name) held[unit].insert(row.what.name);
  }
  tools::Table table({"part", "identity", "holds"});
  for (const ir::Part& part : ir::parts_of(image)) {
    std::string names;
    if (part.kind == ir::PartKind::kUnit) {
      for (const std::string& name : held[part.name]) names += (names.empty() ? "" : ", ") + name;
    }
    const std::string kind(ir::part_kind_name(part.kind));
    table.row(
        {part.name.empty() ? kind : kind + " " + part.name, base::short_hex(part.identity), names});
  }
  return table.text();
}

base::Result<std::string> fleet_file_text(const std::string& path) {
  base::Result<tools::OpenedFleetFile> opened = tools::open_fleet_file(path);
  if (!opened.ok()) return opened.error();
  const auto& [file, digest, parts] = *opened;
  std::string out = "fleet file " + base::short_hex(digest);
  if (!file.author.empty()) out += ", by " + file.author;
  if (!file.text.empty()) out += ": " + file.text;
  if (file.free_table) out += " (the table is free)";
  const auto edits = ir::part_edits(parts.original, parts.edited, parts.original);
  return base::visible_lines(out) + "\n" + tools::part_edits_text(edits, false);
}

}  // namespace stc
