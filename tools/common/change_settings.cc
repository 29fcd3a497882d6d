#include "tools/common/change_settings.h"

#include <set>

#include "ir/bytecode/image.h"
#include "online_change/package/fleet_file.h"
#include "tools/common/files.h"

namespace tools {

void take_change_settings(const ProjectFile& file, ChangeSettings& settings) {
  std::string strategy;
  file.take<std::string>("change.strategy", strategy);
  if (strategy == "in-place" || strategy == "standby") settings.strategy = strategy;
  file.take<bool>("change.restricted", settings.restricted);
  file.take<std::string>("change.health", settings.health);
  file.take<std::string>("change.unless", settings.unless);
  std::string boots;
  file.take<std::string>("change.boots", boots);
  if (!boots.empty()) settings.last_edit = boots == "last-edit";
  file.take<int64_t>("change.data_limit", settings.data_limit);
  file.take<int64_t>("slack.code_percent", settings.code_slack_percent);
}

base::Result<ChangeSettings> change_settings(const std::vector<std::string>& paths) {
  ChangeSettings settings;
  std::set<std::string> read;
  for (const std::string& path : paths) {
    // An image is a product that may lie anywhere, also below the project of somebody else; so is a
    // fleet file, which says its own.
    base::Result<base::Bytes> first = read_first(path, ir::kImageMagic.size());
    if (first.ok() && ir::has_image_magic(*first)) continue;
    if (first.ok() && online_change::has_fleet_magic(*first)) {
      base::Result<base::Bytes> bytes = read_bytes(path);
      if (!bytes.ok()) return bytes.error();
      base::Result<online_change::FleetFile> file = online_change::decode_fleet_file(*bytes);
      if (!file.ok()) return file.error();
      settings.table_additions = !file->free_table;
      continue;
    }
    const std::string nearest = nearest_project_file(path);
    if (nearest.empty() || !read.insert(nearest).second) continue;
    base::Result<ProjectFile> file = read_project_file(nearest);
    if (!file.ok()) return file.error();
    take_change_settings(*file, settings);
  }
  return settings;
}

}  // namespace tools
