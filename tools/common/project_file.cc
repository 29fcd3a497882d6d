#include "tools/common/project_file.h"

#include <algorithm>
#include <filesystem>

#include "tools/common/files.h"

namespace tools {

namespace fs = std::filesystem;

const TomlValue* ProjectFile::find(std::string_view key) const {
  const auto found = table.find(std::string(key));
  return found == table.end() ? nullptr : &found->second;
}

base::Result<ProjectFile> read_project_file(const std::string& path) {
  base::Result<std::string> text = read_text(path);
  if (!text.ok()) return text.error();
  base::Result<TomlTable> table = parse_toml(path, *text);
  if (!table.ok()) return table.error();
  return ProjectFile{path, std::move(*text), std::move(*table)};
}

std::string nearest_project_file(const std::string& path) {
  std::error_code error;
  fs::path folder = fs::path(path);
  if (!fs::is_directory(folder, error)) folder = folder.parent_path();
  // Messages name files as they were typed.
  if (fs::is_regular_file(folder / kProjectFile, error)) return (folder / kProjectFile).string();
  folder = fs::absolute(folder, error).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  while (folder != folder.parent_path()) {
    folder = folder.parent_path();
    const fs::path found = folder / kProjectFile;
    if (!fs::is_regular_file(found, error)) continue;
    const fs::path near = found.lexically_proximate(fs::current_path(error));
    return std::min(near.string(), found.string(),
                    [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  return {};
}

}  // namespace tools
