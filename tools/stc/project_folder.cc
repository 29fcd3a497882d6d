#include "tools/stc/project_folder.h"

#include "ir/bytecode/embedded_sources.h"
#include "tools/common/files.h"

namespace stc {
namespace {

namespace fs = std::filesystem;

base::Error cannot_travel(const std::string& file, const std::string& why) {
  return {base::Refusal::kCannotTravel, file + ": cannot travel with the image: " + why};
}

fs::path whole(const std::string& path) {
  std::error_code error;
  fs::path out = fs::absolute(path, error).lexically_normal();
  return out.has_filename() ? out : out.parent_path();
}

fs::path common_folder(const fs::path& a, const fs::path& b) {
  fs::path out;
  for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end() && *x == *y; ++x, ++y) {
    out /= *x;
  }
  return out;
}

bool leads_out(const fs::path& relative) { return relative.empty() || *relative.begin() == ".."; }

}  // namespace

ProjectFolder::ProjectFolder(const std::vector<std::string>& paths) {
  if (paths.size() == 1 && tools::is_folder(paths[0])) {
    folder_ = whole(paths[0]);
  } else {
    folder_ = whole(paths.front()).parent_path();
    for (const std::string& path : paths) {
      folder_ = common_folder(folder_, whole(path).parent_path());
    }
  }
  std::error_code error;
  real_ = fs::canonical(folder_, error);
}

std::string ProjectFolder::path_of(const std::string& file) const {
  const fs::path relative = whole(file).lexically_relative(folder_);
  return leads_out(relative) ? file : relative.generic_string();
}

base::Result<std::string> ProjectFolder::true_path_of(const std::string& file) const {
  const fs::path relative = whole(file).lexically_relative(folder_);
  if (leads_out(relative)) {
    return cannot_travel(file, "it is outside of the folder of the project, " + folder_.string());
  }
  std::error_code error;
  const fs::path real = fs::canonical(file, error);
  if (error || leads_out(real.lexically_relative(real_))) {
    return cannot_travel(file, "it is a link that leads out of the folder of the project, " +
                                   folder_.string());
  }
  std::string path = relative.generic_string();
  if (ir::is_path_below(path)) return path;
  return cannot_travel(file, "it is hidden, or its name is not printable");
}

}  // namespace stc
