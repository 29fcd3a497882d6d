#include "tools/stc/edit_version.h"

#include "ir/bytecode/verify.h"
#include "linker/merge.h"
#include "online_change/package/fleet_file.h"
#include "online_change/plan/table_edits.h"
#include "tools/common/files.h"
#include "tools/common/signed_content.h"

namespace stc {

bool is_fleet_file(const std::string& path) {
  if (tools::is_folder(path)) return false;
  if (tools::is_signed_as(path, online_change::SignedKind::kFleet)) return true;
  base::Result<base::Bytes> first = tools::read_first(path, online_change::kFleetMagic.size());
  return first.ok() && online_change::has_fleet_magic(*first);
}

base::Result<Version> edited_version(const std::string& path, const BuildOptions& options) {
  if (options.base == nullptr) {
    return base::Error{
        base::Refusal::kUsage,
        "`" + path + "` is an edit of a running program: there is none to make it in"};
  }
  base::Result<base::Bytes> bytes = tools::read_content(path);
  if (!bytes.ok()) return bytes.error();
  base::Result<online_change::FleetFile> file = online_change::decode_fleet_file(*bytes);
  if (!file.ok()) return file.error();
  base::Result<ir::VerifiedImage> original = ir::verify(file->original);
  if (!original.ok()) return original.error();
  base::Result<ir::VerifiedImage> edited = ir::verify(file->edited);
  if (!edited.ok()) return edited.error();
  if (!file->free_table) {
    base::Status kept = online_change::check_table(
        online_change::table_edits(*options.base, edited->image(), online_change::TableSide::kOwn),
        "its own table");
    if (!kept.ok()) return kept.error();
  }
  linker::MergeOptions how{{}, options.matching};
  if (options.step) {
    if (*options.step >= file->steps.size()) {
      return base::Error{base::Refusal::kUsage,
                         "`" + path + "` has " + std::to_string(file->steps.size()) + " steps"};
    }
    how.step = file->steps[*options.step];
  }
  base::Result<ir::Image> merged =
      linker::merge({original->image(), edited->image(), *options.base}, how);
  if (!merged.ok()) return merged.error();
  Version version{std::move(*merged), {}};
  version.bytes = ir::encode(version.image);
  return version;
}

}  // namespace stc
