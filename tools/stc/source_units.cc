#include "tools/stc/source_units.h"

#include "tools/common/child.h"
#include "tools/common/source_command.h"
#include "tools/common/source_files.h"
#include "tools/stc/project_folder.h"

namespace stc {
namespace {

// As the image was built.
base::Result<Project> project_in(const std::string& root, const std::vector<std::string>& build) {
  std::optional<frontend::Dialect> dialect;
  std::vector<std::string> defines;
  std::vector<std::string> paths;
  for (const std::string& argument : build) {
    const auto value_of = [&](std::string_view option) {
      return argument.starts_with(option) ? argument.substr(option.size()) : std::string();
    };
    if (!argument.starts_with("--")) paths.push_back(root + "/" + argument);
    if (std::string value = value_of("--define="); !value.empty()) defines.push_back(value);
    if (const std::string value = value_of("--dialect="); !value.empty()) {
      dialect = frontend::dialect_from_name(value);
    }
  }
  if (paths.empty()) paths.push_back(root);
  base::Result<Project> project = load_project(paths, dialect);
  if (!project.ok()) return project;
  // Settings that somebody sent name files as they like.
  const ProjectFolder folder(project->held_paths());
  for (uint32_t file = 0; file < project->read_sources; ++file) {
    auto inside = folder.true_path_of(std::string(project->sources.file_name(file)));
    if (!inside.ok()) return inside.error();
  }
  for (std::string& define : defines) project->compile.defines.push_back(std::move(define));
  return project;
}

}  // namespace

base::Result<std::vector<Unit>> source_units(const Version& version) {
  base::Result<ir::EmbeddedSources> sources = ir::sources_of(version.bytes);
  if (!sources.ok()) return sources.error();
  if (sources->none()) return tools::no_sources(version.image.name);
  base::Result<std::vector<ir::SourceText>> texts = ir::unpack_sources(*sources);
  if (!texts.ok()) return texts.error();
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string root = folder->file("sources");
  auto written = tools::write_sources(*texts, root, false);
  if (!written.ok()) return written.error();
  base::Result<Project> project = project_in(root, sources->build);
  if (!project.ok()) return project.error();
  return units_of(*project);
}

base::Result<std::vector<Unit>> source_units(const tools::Options& options,
                                             const std::vector<std::string>& paths,
                                             const Version& version) {
  if (paths.size() == 1 && is_image(paths[0])) return source_units(version);
  base::Result<Project> project = open_project(options, paths);
  if (!project.ok()) return project.error();
  return units_of(*project);
}

}  // namespace stc
