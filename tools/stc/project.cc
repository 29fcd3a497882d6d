#include "tools/stc/project.h"

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "base/limits.h"
#include "base/visible_text.h"
#include "tools/common/files.h"
#include "tools/common/project_file.h"
#include "tools/stc/defines.h"
#include "tools/stc/device_tables.h"
#include "tools/stc/importer.h"
#include "tools/stc/memory_budget.h"
#include "tools/stc/warning_settings.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

using tools::ProjectFile;

constexpr std::pair<const char*, uint32_t linker::Slack::*> kSlackKeys[] = {
    {"slack.globals_percent", &linker::Slack::globals_percent},
    {"slack.globals_bytes", &linker::Slack::globals_bytes},
    {"slack.instance_percent", &linker::Slack::instance_percent},
    {"slack.instance_bytes", &linker::Slack::instance_bytes},
    {"slack.program_percent", &linker::Slack::program_percent},
    {"slack.program_bytes", &linker::Slack::program_bytes},
    {"slack.free_bytes", &linker::Slack::free_bytes},
    {"slack.free_percent", &linker::Slack::free_percent},
};

// What concerns every source of the project, also when only some of them are named.
void apply_to_sources(const ProjectFile& file, Project& project) {
  std::string dialect;
  if (file.take<std::string>("dialect", dialect)) {
    project.compile.dialect = *frontend::dialect_from_name(dialect);
  }
  file.take<std::vector<std::string>>("defines", project.compile.defines);
  file.take<bool>("strict_strings", project.compile.strict_strings);
  apply_warning_table(file, project.warnings);
  for (const auto& [key, member] : kSlackKeys) file.take<int64_t>(key, project.slack.*member);
}

// What concerns the program as a whole.
base::Status apply_to_program(const ProjectFile& file, Project& project,
                              std::optional<ProjectFile>& quoted) {
  base::Result<std::vector<ProjectDevice>> devices = read_devices(file);
  if (!devices.ok()) return devices.error();
  project.devices = std::move(*devices);
  if (file.take<std::string>("name", project.name)) project.named = true;
  file.take<bool>("embed_sources", project.embed_sources);
  if (file.take<std::string>("resource", project.compile.resource)) quoted = file;
  base::Result<UnitSettings> units = parse_unit_settings(file);
  if (!units.ok()) return units.error();
  project.units = std::move(*units);
  const tools::TomlValue* const safe = file.find("outputs.safe");
  if (safe == nullptr) return base::Ok{};
  base::Result<SafeSettings> settings = parse_safe_settings(file.path, *safe);
  if (!settings.ok()) return settings.error();
  project.safe = std::move(*settings);
  return base::Ok{};
}

// What the compiler says of `resource` points into the file.
void quote_resource(const ProjectFile& file, Project& project) {
  const tools::TomlPlace place = file.find("resource")->place;
  const base::SourcePos begin = project.sources.add(file.path, file.text, base::TextUse::kQuoted);
  size_t at = 0;
  for (uint32_t line = 1; line < place.line; ++line) at = file.text.find('\n', at) + 1;
  at += place.column - 1;
  const size_t end = file.text.find_first_of(" \t\r\n#", at);
  const auto pos = [&](size_t offset) {
    return base::SourcePos{begin.offset +
                           static_cast<uint32_t>(std::min(offset, file.text.size()))};
  };
  project.compile.resource_at = {pos(at), pos(end)};
}

// Takes over the stc.toml that is nearest to `path` (docs/PROJECT.md). `sources` is replaced when
// `path` is the folder of a file that lists its own. `quoted` becomes the file when messages may
// show a line of it.
base::Status apply_project_file(const std::string& path, Project& project,
                                std::vector<std::string>& sources,
                                std::optional<ProjectFile>& quoted) {
  const std::string nearest = tools::nearest_project_file(path);
  if (nearest.empty()) return base::Ok{};
  base::Result<ProjectFile> file = tools::read_checked_project_file(nearest);
  if (!file.ok()) return file.error();
  apply_to_sources(*file, project);
  const bool whole = nearest == (fs::path(path) / tools::kProjectFile).string();
  if (const auto mistake = mistake_in(project.compile.defines)) {
    const tools::TomlPlace place = file->find("defines")->places[mistake->number];
    return tools::toml_error(nearest, place.line, place.column, mistake->what);
  }
  if (whole) {
    if (base::Status applied = apply_to_program(*file, project, quoted); !applied.ok())
      return applied;
    if (const tools::TomlValue* const list = file->find("sources")) {
      auto listed = listed_sources(*file, *list);
      if (!listed.ok()) return listed.error();
      sources = std::move(*listed);
    }
  }
  if (!whole) project.settings_above = nearest;
  const bool known = std::any_of(project.other_files.begin(), project.other_files.end(),
                                 [&](const ReadFile& other) { return other.path == file->path; });
  if (!known) project.other_files.push_back({file->path, std::move(file->text)});
  return base::Ok{};
}

std::string project_name(const std::string& path) {
  std::error_code error;
  fs::path whole = fs::absolute(path, error).lexically_normal();
  if (whole.filename().empty()) whole = whole.parent_path();
  const std::string name = base::visible(whole.stem().string());
  return name.empty() ? "project" : name;
}

base::Status count_bytes(uint64_t& bytes, const std::string& file, const std::string& text) {
  bytes += text.size();
  expect_input(bytes);
  if (bytes <= base::kMaxSourceBytes) return base::Ok{};
  return base::Error{base::Refusal::kTooMany, file + ": the sources are larger than " +
                                                  std::to_string(base::kMaxSourceBytes) +
                                                  " bytes in all"};
}

base::Result<std::vector<std::string>> expand(const std::string& path, Project& project,
                                              std::optional<ProjectFile>& quoted) {
  base::Result<std::vector<std::string>> found = source_files(path);
  if (!found.ok()) return found;
  const bool folder = tools::is_folder(path);
  if (folder) {
    base::Result<std::vector<std::string>> others = importable_files(path, false);
    if (!others.ok()) return others;
    found->insert(found->end(), others->begin(), others->end());
  }
  base::Status status = apply_project_file(path, project, *found, quoted);
  if (!status.ok()) return status.error();
  if (found->empty()) {
    return base::Error{base::Refusal::kFileNotFound,
                       path + ": no sources (*.st) in this folder or below it"};
  }
  return found;
}

// What several of the paths name comes once: `stc check . main.st`.
class Once {
 public:
  explicit Once(bool counts) : counts_(counts) {}

  bool is_first(const std::string& file) {
    struct stat about {};
    if (!counts_ || ::stat(file.c_str(), &about) != 0) return true;
    return seen_.emplace(about.st_dev, about.st_ino).second;
  }

 private:
  bool counts_;  // one path names no file twice
  std::set<std::pair<dev_t, ino_t>> seen_;
};

}  // namespace

std::vector<std::string> Project::held_paths() const {
  std::vector<std::string> out = paths;
  if (!settings_above.empty()) out.push_back(settings_above);
  return out;
}

std::vector<std::string> Project::read_files() const {
  std::vector<std::string> out;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    out.emplace_back(sources.file_name(file));
  }
  for (const ReadFile& other : other_files) out.push_back(other.path);
  return out;
}

base::Result<Project> load_project(const std::vector<std::string>& paths,
                                   std::optional<frontend::Dialect> dialect) {
  Project project;
  project.name = project_name(paths.front());
  project.paths = paths;
  std::optional<ProjectFile> quoted;
  Importer importer(project.sources);
  Once once(paths.size() > 1);
  uint64_t bytes = 0;
  for (const std::string& path : paths) {
    base::Result<std::vector<std::string>> files = expand(path, project, quoted);
    if (!files.ok()) return files.error();
    for (const std::string& file : *files) {
      if (!once.is_first(file)) continue;
      if (needs_import(file)) {
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
  if (quoted) quote_resource(*quoted, project);
  project.imported = std::move(importer.findings);
  project.kept = std::move(importer.kept);
  if (dialect) project.compile.dialect = *dialect;
  project.compile.name = project.name;
  return project;
}

}  // namespace stc
