#include "tools/stc/project_sources.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <set>

#include "tools/common/files.h"
#include "tools/common/pattern.h"
#include "tools/stc/importer.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

using Files = std::vector<std::string>;

base::Result<Files> files_below(const std::string& folder,
                                const std::function<bool(const std::string&)>& wanted) {
  Files found;
  std::error_code error;
  fs::recursive_directory_iterator walk(folder, error);
  for (; !error && walk != fs::recursive_directory_iterator(); walk.increment(error)) {
    std::string path = walk->path().string();
    if (tools::is_file(path) && wanted(path)) found.push_back(std::move(path));
  }
  if (error) {
    return base::Error{base::Refusal::kFileUnreadable, folder + ": " + error.message()};
  }
  std::sort(found.begin(), found.end());
  return found;
}

using Parts = std::vector<std::string>;
Parts parts_of(const fs::path& path) {
  Parts out;
  for (const fs::path& part : path) out.push_back(part.string());
  return out;
}

// `*` and `?` know no folders, `**` stands for any. What a pattern names counts with all below it.
bool path_matches(const Parts& pattern, const Parts& path) {
  return tools::matches_parts(
      pattern, path, [](const std::string& part) { return part == "**"; },
      [](const std::string& part, const std::string& name) {
        return tools::matches_file(part, name);
      });
}

bool has_wildcard(const std::string& text) { return text.find_first_of("*?") != std::string::npos; }

// The folders in front of the first wildcard.
fs::path fixed_folder(const fs::path& pattern) {
  fs::path out;
  for (const fs::path& part : pattern) {
    if (has_wildcard(part.string())) break;
    out /= part;
  }
  return out;
}

base::Result<Files> matching_files(const fs::path& folder, const std::string& element) {
  const fs::path pattern = fs::path(element).lexically_normal();
  const fs::path fixed = fixed_folder(pattern);
  const std::string top = (folder / fixed).string();
  if (!tools::is_folder(top)) return Files();
  Parts rest = parts_of(pattern.lexically_relative(fixed.empty() ? "." : fixed));
  rest.push_back("**");
  return files_below(top, [&](const std::string& path) {
    const fs::path below = fs::path(path).lexically_relative(top);
    return (is_source_name(path) || is_importable(path)) && path_matches(rest, parts_of(below));
  });
}

base::Result<Files> files_of(const fs::path& folder, const std::string& element) {
  if (has_wildcard(element)) return matching_files(folder, element);
  const std::string path = (folder / element).string();
  base::Result<Files> found = source_files(path);
  if (!found.ok() || !tools::is_folder(path)) return found;
  base::Result<Files> others = importable_files(path, false);
  if (!others.ok()) return others;
  found->insert(found->end(), others->begin(), others->end());
  return found;
}

}  // namespace

base::Result<Files> source_files(const std::string& path) {
  if (!tools::is_there(path)) {
    return base::Error{base::Refusal::kFileNotFound, path + ": no such file or directory"};
  }
  if (!tools::is_folder(path)) return Files{path};
  return files_below(path, is_source_name);
}

base::Result<Files> importable_files(const std::string& path, bool any_xml) {
  auto found = files_below(path, [&](const std::string& file) {
    return any_xml ? is_importable(file) : is_foreign(file);
  });
  if (!found.ok()) return found;
  return without_listed(*found);
}

base::Result<Files> listed_sources(const tools::ProjectFile& file, const tools::TomlValue& list) {
  const fs::path folder = fs::path(file.path).parent_path();
  const auto& elements = *std::get_if<Files>(&list.data);
  if (elements.empty()) {
    return tools::toml_error(file.path, list.place.line, list.place.column,
                             "`sources` is empty; leave it out for all sources of the folder");
  }
  Files out;
  std::set<std::string> known;
  for (size_t i = 0; i < elements.size(); ++i) {
    const auto wrong = [&](const std::string& why) {
      return tools::toml_error(file.path, list.places[i].line, list.places[i].column,
                               "`" + elements[i] + "` " + why);
    };
    base::Result<Files> found = files_of(folder, elements[i]);
    if (!found.ok() && found.error().refusal == base::Refusal::kFileNotFound) {
      return wrong("is not there; paths begin at the folder of this file");
    }
    if (!found.ok()) return found;
    if (found->empty()) return wrong("names no source; sources are *.st and files of TwinCAT");
    for (std::string& path : *found) {
      if (known.insert(fs::path(path).lexically_normal().string()).second) {
        out.push_back(std::move(path));
      }
    }
  }
  return out;
}

}  // namespace stc
