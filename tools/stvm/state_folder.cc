#include "tools/stvm/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

namespace stvm {
namespace {

base::Error unwritable(const std::string& path, const char* why) {
  return {base::Refusal::kFileUnwritable, path + ": " + why};
}

base::Status make_folder(const std::string& path) {
  std::error_code error;
  std::filesystem::path parent = std::filesystem::path(path).parent_path();
  if (!parent.empty()) std::filesystem::create_directories(parent, error);
  if (::mkdir(path.c_str(), 0700) == 0 || errno == EEXIST) return base::Ok{};
  return unwritable(path, std::strerror(errno));
}

}  // namespace

base::Result<StateFolder> StateFolder::open(const std::string& path) {
  base::Status made = make_folder(path);
  if (!made.ok()) return made.error();
  std::string file = path + "/lock";
  vm::Descriptor lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  if (!lock.valid()) return unwritable(file, std::strerror(errno));
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) != 0) {
    if (errno != EWOULDBLOCK) return unwritable(file, std::strerror(errno));
    return base::Error{base::Refusal::kAlreadyRunning, "a controller already runs in " + path};
  }
  return StateFolder(std::move(lock));
}

bool holds_program(const std::string& directory) {
  std::error_code error;
  const std::filesystem::path folder(directory);
  return std::filesystem::exists(folder / "control_0", error) ||
         std::filesystem::exists(folder / "control_1", error);
}

std::vector<std::string> stored_resources(const std::string& directory) {
  std::vector<std::string> names;
  std::error_code error;
  if (holds_program(directory)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(directory, error)) {
    if (holds_program(entry.path().string())) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace stvm
