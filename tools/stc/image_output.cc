#include "tools/stc/image_output.h"

#include <cstdio>
#include <filesystem>

#include "base/hash.h"
#include "tools/common/files.h"
#include "tools/common/outputs.h"

namespace stc {

base::Result<std::string> image_path(const std::string& output, const std::string& resource,
                                     const std::string& project) {
  const std::filesystem::path path(output);
  std::error_code error;
  if (path.filename().empty()) std::filesystem::create_directories(path, error);
  if (error) return base::Error{base::Refusal::kFileUnwritable, output + ": " + error.message()};
  if (std::filesystem::is_directory(path, error)) {
    const bool usable = project.find('/') == std::string::npos;
    const std::string alone = usable ? project : "program";
    return (path / ((resource.empty() ? alone : resource) + ".img")).string();
  }
  if (resource.empty()) return output;
  const std::string name = path.stem().string() + "." + resource + path.extension().string();
  return (path.parent_path() / name).string();
}

base::Status write_image(const std::string& path, const ir::Image& image, const base::Bytes& bytes,
                         bool with_line) {
  base::Status written = tools::write_file(path, bytes);
  if (!written.ok() || !with_line) return written;
  std::fprintf(stderr, "%s: %zu POUs, %zu bytes, hash %s\n", path.c_str(), image.pous.size(),
               bytes.size(), base::short_hex(ir::digest(bytes)).c_str());
  return base::Ok{};
}

base::Status write_images(const std::vector<ResourceVersion>& versions, const std::string& output,
                          const Project& project, bool with_line) {
  std::vector<std::string> paths;
  for (const ResourceVersion& made : versions) {
    const std::string resource = versions.size() > 1 ? made.resource : std::string();
    base::Result<std::string> path = image_path(output, resource, project.name);
    if (!path.ok()) return path.error();
    base::Status free = tools::check_output(*path, project.read_files());
    if (!free.ok()) return free;
    paths.push_back(std::move(*path));
  }
  for (size_t i = 0; i < versions.size(); ++i) {
    const Version& made = versions[i].version;
    base::Status written = write_image(paths[i], made.image, made.bytes, with_line);
    if (!written.ok()) return written;
  }
  return base::Ok{};
}

}  // namespace stc
