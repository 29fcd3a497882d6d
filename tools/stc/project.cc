#include "tools/stc/project.h"

#include <algorithm>
#include <filesystem>
#include <functional>

#include "base/limits.h"
#include "tools/common/change_settings.h"
#include "tools/common/files.h"
#include "tools/common/toml.h"
#include "tools/stc/device_tables.h"
#include "tools/stc/format_settings.h"
#include "tools/stc/importer.h"
#include "tools/stc/memory_budget.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

base::Result<std::vector<std::string>> files_below(
    const std::string& folder, const std::function<bool(const std::string&)>& wanted) {
  std::vector<std::string> found;
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

// One known key of stc.toml.
struct Key {
  const char* name;
  uint32_t linker::Slack::*slack;
};
constexpr Key kSlackKeys[] = {
    {"slack.globals_percent", &linker::Slack::globals_percent},
    {"slack.globals_bytes", &linker::Slack::globals_bytes},
    {"slack.instance_percent", &linker::Slack::instance_percent},
    {"slack.instance_bytes", &linker::Slack::instance_bytes},
    {"slack.program_percent", &linker::Slack::program_percent},
    {"slack.program_bytes", &linker::Slack::program_bytes},
    {"slack.free_bytes", &linker::Slack::free_bytes},
    {"slack.free_percent", &linker::Slack::free_percent},
};

template <class T>
base::Result<T> typed(const std::string& file, const std::string& key,
                      const tools::TomlValue& value, const char* what) {
  if (const T* data = std::get_if<T>(&value.data)) return *data;
  return tools::toml_error(file, value.line, value.column, "`" + key + "` must be " + what);
}

base::Status apply_slack(const std::string& file, const std::string& key,
                         const tools::TomlValue& value, linker::Slack& slack) {
  for (const Key& known : kSlackKeys) {
    if (key != known.name) continue;
    base::Result<int64_t> number = typed<int64_t>(file, key, value, "a whole number");
    if (!number.ok()) return number.error();
    if (*number < 0 || *number > base::kMaxTypeBytes) {
      return tools::toml_error(
          file, value.line, value.column,
          "`" + key + "` must be between 0 and " + std::to_string(base::kMaxTypeBytes));
    }
    slack.*known.slack = static_cast<uint32_t>(*number);
    return base::Ok{};
  }
  return tools::toml_error(
      file, value.line, value.column,
      "unknown key `" + key +
          "`; known are name, dialect, resource, sources, defines, strict_strings, embed_sources "
          "and the tables [slack], [change], [outputs], [format] and [devices.NAME]");
}

// Applies stc.toml of `folder`; `sources` is replaced when the file lists its own.
base::Status apply_project_file(const std::string& folder, Project& project,
                                std::vector<std::string>& sources) {
  std::string file = (fs::path(folder) / "stc.toml").string();
  if (!tools::is_there(file)) return base::Ok{};
  base::Result<std::string> text = tools::read_text(file);
  if (!text.ok()) return text.error();
  base::Result<tools::TomlTable> table = tools::parse_toml(file, *text);
  if (!table.ok()) return table.error();
  project.other_files.push_back({file, std::move(*text)});
  base::Result<std::vector<ProjectDevice>> devices = read_devices(file, *table);
  if (!devices.ok()) return devices.error();
  project.devices = std::move(*devices);
  for (const auto& [key, value] : *table) {
    if (key.starts_with(kDeviceTables)) continue;
    if (key == "name") {
      base::Result<std::string> name = typed<std::string>(file, key, value, "a text");
      if (!name.ok()) return name.error();
      project.name = *name;
      project.named = true;
    } else if (key == "embed_sources") {
      auto embed = typed<bool>(file, key, value, "true or false");
      if (!embed.ok()) return embed.error();
      project.embed_sources = *embed;
    } else if (key == "dialect") {
      base::Result<std::string> name = typed<std::string>(file, key, value, "a text");
      if (!name.ok()) return name.error();
      auto dialect = frontend::dialect_from_name(*name);
      if (!dialect) {
        return tools::toml_error(file, value.line, value.column, frontend::unknown_dialect(*name));
      }
      project.compile.dialect = *dialect;
    } else if (key == "resource") {
      base::Result<std::string> name = typed<std::string>(file, key, value, "a text");
      if (!name.ok()) return name.error();
      project.compile.resource = *name;
    } else if (key == "sources") {
      auto list = typed<std::vector<std::string>>(file, key, value, "a list of texts");
      if (!list.ok()) return list.error();
      sources.clear();
      for (const std::string& entry : *list) sources.push_back((fs::path(folder) / entry).string());
    } else if (key.starts_with(kFormatTable)) {
      frontend::FormatOptions unused;  // only its own command needs them, but all check them
      base::Status status = apply_format_key(file, key, value, unused);
      if (!status.ok()) return status;
    } else if (key.starts_with(tools::kChangeTable)) {
      tools::ChangeSettings unused;  // stvm's affair
      base::Status status = tools::apply_change_key(file, key, value, unused);
      if (!status.ok()) return status;
    } else if (key == "defines") {
      auto list = typed<std::vector<std::string>>(file, key, value, "a list of texts");
      if (!list.ok()) return list.error();
      project.compile.defines = *list;
    } else if (key == "strict_strings") {
      auto strict = typed<bool>(file, key, value, "true or false");
      if (!strict.ok()) return strict.error();
      project.compile.strict_strings = *strict;
    } else if (key == "outputs.safe") {
      base::Result<SafeSettings> safe = parse_safe_settings(file, value);
      if (!safe.ok()) return safe.error();
      project.safe = std::move(*safe);
    } else if (base::Status status = apply_slack(file, key, value, project.slack); !status.ok()) {
      return status;
    }
  }
  return base::Ok{};
}

std::string project_name(const std::string& path) {
  fs::path normal = fs::path(path).lexically_normal();
  if (normal.filename().empty()) normal = normal.parent_path();
  std::string name = normal.stem().string();
  return name.empty() || name == "." ? "project" : name;
}

base::Status count_bytes(uint64_t& bytes, const std::string& file, const std::string& text) {
  bytes += text.size();
  expect_input(bytes);
  if (bytes <= base::kMaxSourceBytes) return base::Ok{};
  return base::Error{base::Refusal::kTooMany, file + ": the sources are larger than " +
                                                  std::to_string(base::kMaxSourceBytes) +
                                                  " bytes in all"};
}

base::Result<std::vector<std::string>> expand(const std::string& path, Project& project) {
  base::Result<std::vector<std::string>> found = source_files(path);
  if (!found.ok() || !tools::is_folder(path)) return found;
  base::Result<std::vector<std::string>> others = importable_files(path, false);
  if (!others.ok()) return others;
  found->insert(found->end(), others->begin(), others->end());
  base::Status status = apply_project_file(path, project, *found);
  if (!status.ok()) return status.error();
  if (found->empty()) {
    return base::Error{base::Refusal::kFileNotFound,
                       path + ": no sources (*.st) in this folder or below it"};
  }
  return found;
}

}  // namespace

bool is_source_name(const std::string& path) {
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".st" || extension == ".iecst" || extension == ".exp";
}

base::Result<std::vector<std::string>> source_files(const std::string& path) {
  if (!tools::is_there(path)) {
    return base::Error{base::Refusal::kFileNotFound, path + ": no such file or directory"};
  }
  if (!tools::is_folder(path)) return std::vector<std::string>{path};
  return files_below(path, is_source_name);
}

base::Result<std::vector<std::string>> importable_files(const std::string& path, bool any_xml) {
  auto found = files_below(path, [&](const std::string& file) {
    return any_xml ? is_importable(file) : is_twincat(file);
  });
  if (!found.ok()) return found;
  return without_listed(*found);
}

base::Result<Project> load_project(const std::vector<std::string>& paths,
                                   std::optional<frontend::Dialect> dialect) {
  Project project;
  project.name = project_name(paths.front());
  project.paths = paths;
  Importer importer(project.sources);
  uint64_t bytes = 0;
  for (const std::string& path : paths) {
    base::Result<std::vector<std::string>> files = expand(path, project);
    if (!files.ok()) return files.error();
    for (const std::string& file : *files) {
      if (is_importable(file)) {
        base::Status status = importer.add(file);
        if (!status.ok()) return status.error();
        continue;
      }
      base::Result<std::string> text = tools::read_text(file);
      if (!text.ok()) return text.error();
      if (text->find('\0') != std::string::npos) {
        return base::Error{base::Refusal::kFileUnreadable,
                           file + ": neither a source text nor an image of this version"};
      }
      base::Status fits = count_bytes(bytes, file, *text);
      if (!fits.ok()) return fits.error();
      project.sources.add(file, std::move(*text));
    }
  }
  importer.finish();
  project.read_sources = project.sources.file_count();
  for (ReadFile& file : importer.read_files) project.other_files.push_back(std::move(file));
  for (Importer::Made& made : importer.made) {
    const std::string name = made.origin + "/" + made.source.name;
    base::Status fits = count_bytes(bytes, name, made.source.text);
    if (!fits.ok()) return fits.error();
    project.sources.add(name, std::move(made.source.text));
  }
  project.imported = std::move(importer.findings);
  project.kept = std::move(importer.kept);
  if (dialect) project.compile.dialect = *dialect;
  project.compile.name = project.name;
  return project;
}

}  // namespace stc
