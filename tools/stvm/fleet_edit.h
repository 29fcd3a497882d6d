// The edit of a fleet file, as `stvm fleet` goes about with it, and by what it is known in the
// journal of a controller (E-33).
#pragma once

#include <string>
#include <vector>

#include "tools/common/fleet_parts.h"
#include "tools/common/options.h"

namespace stvm {

struct FleetEdit {
  std::string path;
  base::Digest digest{};
  tools::FleetParts parts;
  bool matching = false;  // only the units that fit
  std::vector<std::string> steps = {};  // E-25; ir::of_step()
  bool steps_if_needed = false;
};

// Both versions are verified.
base::Result<FleetEdit> read_fleet_edit(const std::string& path);
// With `--trust KEYS` it must be signed by one of them, says `stc key verify`.
base::Status check_fleet_signature(const std::string& path, const tools::Options& options);
// "fleet file 9c4c6cbc5a09"
std::string fleet_note(const base::Digest& digest);
// The note of a file, where `stvm change` is given one; "": it is no fleet file.
std::string fleet_note_of(const std::string& path);

}  // namespace stvm
