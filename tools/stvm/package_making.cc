#include "tools/stvm/package_making.h"

#include "tools/common/child.h"
#include "tools/common/files.h"

namespace stvm {

base::Result<base::Bytes> make_package(const Sources& sources, const PackageOptions& options,
                                       base::ByteSpan running) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string base_file = folder->file("running.img");
  const std::string package_file = folder->file("change.pkg");
  base::Status written = tools::write_file(base_file, running);
  if (!written.ok()) return written.error();
  std::vector<std::string> command = {"package", "--base", base_file, "-o", package_file};
  if (options.restricted) command.push_back("--restricted");
  if (options.matching) command.push_back("--matching");
  if (options.step != 0) command.push_back("--step=" + std::to_string(options.step));
  base::Status made = tools::run_beside("stc", stc_arguments(command, sources));
  if (!made.ok()) return made.error();
  return tools::read_bytes(package_file);
}

base::Result<base::Bytes> sign_package(base::ByteSpan package, const std::string& key_file) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("change.pkg");
  base::Status done = tools::write_file(file, package);
  if (!done.ok()) return done.error();
  done =
      tools::run_beside("stc", {"key", "sign", file, "--key", key_file, "--days", "1", "-o", file});
  if (!done.ok()) return done.error();
  return tools::read_bytes(file);
}

}  // namespace stvm
