#include "tools/common/project_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>

#include "base/visible_text.h"
#include "tools/common/files.h"

namespace tools {

namespace fs = std::filesystem;

const TomlValue* ProjectFile::find(std::string_view key) const {
  const auto found = table.find(std::string(key));
  return found == table.end() ? nullptr : &found->second;
}

namespace {

// They become names in an image, which holds none with control characters.
base::Status check_texts(const std::string& path, const TomlTable& table) {
  for (const auto& [key, value] : table) {
    const auto wrong = [&](TomlPlace place) {
      return toml_error(path, place.line, place.column,
                        "the text of `" + key + "` has control characters");
    };
    if (const auto* text = std::get_if<std::string>(&value.data)) {
      if (base::has_control(*text)) return wrong(value.place);
    } else if (const auto* list = std::get_if<std::vector<std::string>>(&value.data)) {
      for (size_t i = 0; i < list->size(); ++i) {
        if (base::has_control((*list)[i])) return wrong(value.places[i]);
      }
    }
  }
  return base::Ok{};
}

bool has_entry(const fs::path& path) {
  struct stat info {};
  return ::lstat(path.c_str(), &info) == 0;
}

}  // namespace

base::Result<ProjectFile> read_project_file(const std::string& path) {
  base::Result<std::string> text = read_text(path);
  if (!text.ok()) return text.error();
  return parse_project_file(path, std::move(*text));
}

base::Result<ProjectFile> parse_project_file(const std::string& path, std::string text) {
  base::Result<TomlTable> table = parse_toml(path, text);
  if (!table.ok()) return table.error();
  if (base::Status texts = check_texts(path, *table); !texts.ok()) return texts.error();
  return ProjectFile{path, std::move(text), std::move(*table)};
}

std::string nearest_project_file(const std::string& path) {
  std::error_code error;
  fs::path folder = fs::path(path);
  if (!fs::is_directory(folder, error)) folder = folder.parent_path();
  // Messages name files as they were typed.
  if (has_entry(folder / kProjectFile)) return (folder / kProjectFile).string();
  folder = fs::absolute(folder, error).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  while (folder != folder.parent_path()) {
    folder = folder.parent_path();
    const fs::path found = folder / kProjectFile;
    if (!has_entry(found)) continue;
    const fs::path near = found.lexically_proximate(fs::current_path(error));
    return std::min(near.string(), found.string(),
                    [](const auto& a, const auto& b) { return a.size() < b.size(); });
  }
  return {};
}

}  // namespace tools
