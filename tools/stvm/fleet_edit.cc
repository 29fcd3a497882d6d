#include "tools/stvm/fleet_edit.h"

namespace stvm {

base::Result<FleetEdit> read_fleet_edit(const std::string& path) {
  base::Result<tools::OpenedFleetFile> opened = tools::open_fleet_file(path);
  if (!opened.ok()) return opened.error();
  return FleetEdit{path, opened->digest, std::move(opened->parts), false};
}

std::string fleet_note(const base::Digest& digest) {
  return "fleet file " + base::short_hex(digest);
}

}  // namespace stvm
