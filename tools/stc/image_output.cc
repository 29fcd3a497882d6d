#include "tools/stc/image_output.h"

#include <cstdio>
#include <filesystem>

#include "base/hash.h"
#include "tools/common/files.h"

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
                          const std::string& project, bool with_line) {
  for (const ResourceVersion& made : versions) {
    const std::string resource = versions.size() > 1 ? made.resource : std::string();
    base::Result<std::string> path = image_path(output, resource, project);
    if (!path.ok()) return path.error();
    base::Status written = write_image(*path, made.version.image, made.version.bytes, with_line);
    if (!written.ok()) return written;
  }
  return base::Ok{};
}

}  // namespace stc
