#include "tools/stvm/compiler.h"

#include <algorithm>
#include <filesystem>

#include "tools/common/child.h"
#include "tools/common/files.h"

namespace stvm {

Sources sources_of(const tools::Options& options) {
  return {options.arguments(), options.text("--dialect")};
}

std::vector<std::string> stc_arguments(std::vector<std::string> command, const Sources& sources) {
  if (!sources.dialect.empty()) {
    command.push_back("--dialect");
    command.push_back(sources.dialect);
  }
  command.push_back("--");
  command.insert(command.end(), sources.paths.begin(), sources.paths.end());
  return command;
}

bool is_image(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  static const base::Bytes kMagic = [] {
    base::Bytes empty = ir::encode(ir::Image{});
    return base::Bytes(empty.begin(), empty.begin() + 8);
  }();
  return bytes.ok() && bytes->size() >= kMagic.size() &&
         std::equal(kMagic.begin(), kMagic.end(), bytes->begin());
}

base::Result<ir::VerifiedImage> load_program(const Sources& sources) {
  std::string path = sources.paths.front();
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  if (sources.paths.size() != 1 || !is_image(path)) {
    path = folder->file("program.img");
    base::Status built =
        tools::run_beside("stc", stc_arguments({"build", "--quiet", "-o", path}, sources));
    if (!built.ok()) return built.error();
  }
  base::Result<base::Bytes> bytes = tools::read_bytes(path);
  if (!bytes.ok()) return bytes.error();
  return ir::verify(*bytes);
}

}  // namespace stvm
