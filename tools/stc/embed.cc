#include "tools/stc/embed.h"

#include <utility>
#include <vector>

#include "tools/common/files.h"
#include "tools/stc/project_folder.h"

namespace stc {
base::Result<Embedding> Embedding::of(const Project& project) {
  Embedding out;
  if (!project.embed_sources) return out;
  const ProjectFolder folder(project.held_paths());
  std::vector<ir::SourceText> files;
  const auto add = [&](const std::string& name, std::string text) -> base::Status {
    base::Result<std::string> path = folder.true_path_of(name);
    if (!path.ok()) return path.error();
    if (out.paths_.emplace(name, *path).second) files.push_back({*path, std::move(text)});
    return base::Ok{};
  };
  for (uint32_t file = 0; file < project.read_sources; ++file) {
    if (!project.sources.is_source(file)) continue;
    base::Status added = add(std::string(project.sources.file_name(file)),
                             std::string(project.sources.text(file)));
    if (!added.ok()) return added.error();
  }
  for (const ReadFile& file : project.other_files) {
    if (base::Status added = add(file.path, file.text); !added.ok()) return added.error();
  }
  std::vector<std::string> build = project.build_options;
  if (project.held_paths().size() > 1 || !tools::is_folder(project.paths[0])) {
    for (const std::string& named : project.paths) {
      base::Result<std::string> path = folder.true_path_of(named);
      if (!path.ok()) return path.error();
      build.push_back(*path);
    }
  }
  base::Result<ir::EmbeddedSources> packed =
      ir::pack_sources(std::move(files), std::move(build));
  if (!packed.ok()) return packed.error();
  out.section_ = ir::encode_sources(*packed);
  return out;
}

// The path of a document that sources were made of: `plant.xml/Motor.st`.
std::string Embedding::path_of(const std::string& file) const {
  if (const auto known = paths_.find(file); known != paths_.end()) return known->second;
  for (size_t slash = file.rfind('/'); slash != std::string::npos && slash != 0;
       slash = file.rfind('/', slash - 1)) {
    const auto known = paths_.find(file.substr(0, slash));
    if (known != paths_.end()) return known->second + file.substr(slash);
  }
  return file;
}

void Embedding::name_files(ir::Image& image) const {
  if (section_.empty()) return;
  for (ir::LinkedPou& pou : image.pous) pou.file = path_of(pou.file);
}

const ir::Image& Embedding::named(const ir::Image& image, ir::Image& copy) const {
  if (section_.empty()) return image;
  copy = image;
  name_files(copy);
  return copy;
}

}  // namespace stc
