// An edit in words: what a fleet file changes, and what a controller has of it (E-08, E-11).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ir/bytecode/part_edits.h"
#include "ir/bytecode/verify.h"
#include "online_change/package/fleet_file.h"
#include "online_change/plan/table_edits.h"
#include "tools/common/json.h"

namespace tools {

// The parts of both versions, which are verified first.
struct FleetParts {
  std::vector<ir::Part> original;
  std::vector<ir::Part> edited;
  std::optional<ir::VerifiedImage> edited_image;  // always there; its table
  bool free_table = false;                        // E-17

  const ir::UnitMembers& units() const { return edited_image->image().unit_members; }
  // Those of a controller's program, in the units of the edit (E-01).
  std::vector<ir::Part> of(const ir::Image& image) const { return ir::parts_of(image, units()); }
};
base::Result<FleetParts> parts_of(const online_change::FleetFile& file);
// A fleet file with what it changes.
struct OpenedFleetFile {
  online_change::FleetFile file;
  base::Digest digest{};
  FleetParts parts;
};
base::Result<OpenedFleetFile> open_fleet_file(const std::string& path);

// A controller's own table against that of the edit (E-16); none where the table is free.
std::vector<online_change::TableEdit> own_table_edits(const FleetParts& parts,
                                                      const ir::Image& own);

// "edited", "added" or "removed".
std::string part_change_name(const ir::PartEdit& edit);
// "ok", "has it", "missing" or "different", as people and JSON say it.
std::string_view part_state_name(ir::PartState state);

// A table: what the edit changes; with `here`, what the target has of each.
std::string part_edits_text(const std::vector<ir::PartEdit>& edits, bool here);
// Arrays.
void own_table_json(const std::vector<online_change::TableEdit>& edits, JsonWriter& json);
void part_edits_json(const std::vector<ir::PartEdit>& edits, bool here, JsonWriter& json);

}  // namespace tools
