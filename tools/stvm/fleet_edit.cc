#include "tools/stvm/fleet_edit.h"

#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"

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

base::Status check_fleet_signature(const std::string& path, const tools::Options& options) {
  if (!options.has("--trust")) return base::Ok{};
  return tools::run_beside("stc",
                           {"key", "verify", path, "--quiet", "--trust", options.text("--trust")});
}

std::string fleet_note(const base::Digest& digest) {
  return "fleet file " + base::short_hex(digest);
}

std::string fleet_note_of(const std::string& path) {
  if (!tools::is_file(path)) return {};
  base::Result<base::Bytes> first = tools::read_first(path, online_change::kFleetMagic.size());
  const bool is_plain = first.ok() && online_change::has_fleet_magic(*first);
  if (!is_plain && !tools::is_signed_as(path, online_change::SignedKind::kFleet)) return {};
  base::Result<base::Bytes> bytes = tools::read_content(path);
  return bytes.ok() ? fleet_note(online_change::fleet_digest(*bytes)) : std::string();
}

}  // namespace stvm
