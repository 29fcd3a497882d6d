// `[units]` of stc.toml (E-01): which POUs are one unit of an edit, and which actions of a PROGRAM
// are sections, units by themselves (docs/FLEET.md).
//
//   [units]
//   Pumping = ["Pump", "PumpLogic"]
//   Filling = ["Main.Fill", "Main.Rinse"]
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/identities.h"
#include "tools/common/project_file.h"

namespace stc {

struct UnitSettings {
  struct Entry {
    std::string name;  // "Pump" or "Main.Fill"
    std::string unit;
    tools::TomlPlace place{};
  };
  std::string file;            // for messages; empty: there are none
  std::vector<Entry> entries;  // no name twice

  ir::UnitMembers members() const;  // as Image::unit_members
};

// Errors: kBadProject, with the entry and its place.
base::Result<UnitSettings> parse_unit_settings(const tools::ProjectFile& file);
// Each name is that of a POU or of a section in one of the programs; kBadProject.
base::Status check_unit_settings(const UnitSettings& settings,
                                 std::span<const ir::Image* const> programs);

}  // namespace stc
