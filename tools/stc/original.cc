#include "tools/stc/original.h"

#include <filesystem>

#include "tools/common/child.h"
#include "tools/stc/importer.h"
#include "tools/stc/project_sources.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

constexpr const char* kControlSocket = "control";  // vm/runtime/socket_server.h

bool is_controller(const std::string& place) {
  std::error_code ignored;
  if (fs::is_directory(place, ignored)) return fs::is_socket(fs::path(place) / kControlSocket);
  const bool file = fs::exists(place, ignored) || place.find('/') != std::string::npos ||
                    place.ends_with(".img") || is_source_name(place) || is_importable(place);
  return !file;
}

}  // namespace

base::Result<Version> running_version(const std::string& place) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("running.img");
  std::error_code ignored;
  const char* option = fs::is_directory(place, ignored) ? "--dir" : "--host";
  base::Status fetched = tools::run_beside("stvm", {"image", option, place, "-o", file});
  if (!fetched.ok()) return fetched.error();
  return read_image(file);
}

base::Result<Version> open_original(const tools::Options& options, const std::string& place) {
  return is_controller(place) ? running_version(place) : open_version(options, {place}, {});
}

}  // namespace stc
