#include "tools/stvm/fleet_edit.h"

#include "tools/common/files.h"

namespace stvm {

base::Result<FleetEdit> read_fleet_edit(const std::string& path) {
  base::Result<tools::OpenedFleetFile> opened = tools::open_fleet_file(path);
  if (!opened.ok()) return opened.error();
  return FleetEdit{path,
                   opened->digest,
                   std::move(opened->parts),
                   false,
                   std::move(opened->file.steps),
                   opened->file.steps_if_needed};
}

std::string fleet_note(const base::Digest& digest) {
  return "fleet file " + base::short_hex(digest);
}

std::string fleet_note_of(const std::string& path) {
  if (!tools::is_file(path)) return {};
  base::Result<base::Bytes> first = tools::read_first(path, online_change::kFleetMagic.size());
  if (!first.ok() || !online_change::has_fleet_magic(*first)) return {};
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  return bytes.ok() ? fleet_note(online_change::fleet_digest(*bytes)) : std::string();
}

}  // namespace stvm
