// An edit in words: what a fleet file changes, and what a controller has of it (E-08, E-11).
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/part_edits.h"
#include "online_change/package/fleet_file.h"
#include "tools/common/json.h"

namespace tools {

// The parts of both versions, which are verified first.
struct FleetParts {
  std::vector<ir::Part> original;
  std::vector<ir::Part> edited;
};
base::Result<FleetParts> parts_of(const online_change::FleetFile& file);

// "edited", "added" or "removed".
std::string part_change_name(const ir::PartEdit& edit);
// "ok", "has it", "missing" or "different", as people and JSON say it.
std::string_view part_state_name(ir::PartState state);

// A table: what the edit changes; with `here`, what the target has of each.
std::string part_edits_text(const std::vector<ir::PartEdit>& edits, bool here);
// An array.
void part_edits_json(const std::vector<ir::PartEdit>& edits, bool here, JsonWriter& json);

}  // namespace tools
