#include "tools/stvm/state_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "online_change/store/store.h"

namespace stvm {
namespace {

base::Error unwritable(const std::string& path, const char* why) {
  return {base::Refusal::kFileUnwritable, path + ": " + why};
}

base::Error unsafe(const std::string& path, const std::string& why) {
  return {base::Refusal::kUnsafeFolder, path + ": " + why};
}

// False: it was there.
base::Result<bool> make_folder(const std::string& path) {
  if (::mkdir(path.c_str(), 0700) == 0) return true;
  if (errno == EEXIST) return false;
  const int code = errno;
  const std::string parent = std::filesystem::path(path).parent_path();
  if (code != ENOENT || parent.empty() || parent == path) {
    return unwritable(path, std::strerror(code));
  }
  if (base::Result<bool> made = make_folder(parent); !made.ok()) return made;
  if (::mkdir(path.c_str(), 0700) == 0) return true;
  return unwritable(path, std::strerror(errno));
}

// Who writes a folder can exchange what is in it, but not in a sticky one what belongs to others.
base::Status check_folder(const std::string& path, bool parent) {
  struct stat info {};
  if (::stat(path.c_str(), &info) != 0) return unwritable(path, std::strerror(errno));
  const bool ours = info.st_uid == ::geteuid() || info.st_uid == 0;
  if (!ours) {
    return unsafe(path,
                  "it belongs to another user, who could exchange what runs; use another "
                  "directory, or `chown` it");
  }
  const bool by_others = (info.st_mode & (S_IWGRP | S_IWOTH)) != 0;
  if (!by_others || (parent && (info.st_mode & S_ISVTX) != 0)) return base::Ok{};
  return unsafe(path,
                "others can write it and could exchange what runs: `chmod go-w " + path + "`");
}

base::Status check_folders(std::filesystem::path at) {
  base::Status safe = check_folder(at, false);
  while (safe.ok() && at != at.root_path()) {
    at = at.parent_path();
    safe = check_folder(at, true);
  }
  return safe;
}

}  // namespace

base::Result<StateFolder> StateFolder::open(const std::string& path, bool create) {
  std::error_code error;
  if (!create && !std::filesystem::exists(path, error) && !error) {
    return base::Error{base::Refusal::kFileNotFound, path + " does not exist"};
  }
  const base::Result<bool> made = make_folder(path);
  if (!made.ok()) return made.error();
  const std::string real = std::filesystem::canonical(path, error);
  if (error) return unwritable(path, error.message().c_str());
  base::Status safe = check_folders(real);
  if (!safe.ok()) return safe.error();
  const std::string file = real + "/lock";
  // The folder itself, whose lock nobody can remove, and the file that older versions lock.
  vm::Descriptor folder(::open(real.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder.valid()) return unwritable(real, std::strerror(errno));
  constexpr int kSafely = O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW;  // a link could lead elsewhere
  vm::Descriptor lock(::openat(folder.get(), "lock", O_RDWR | O_CREAT | kSafely, 0600));
  if (!lock.valid() && errno == ELOOP) return unwritable(file, "it is a link; remove it");
  // The file system is read-only: the program can run from it all the same.
  const bool read_only = !lock.valid() && errno == EROFS;
  if (!lock.valid() && !read_only) return unwritable(file, std::strerror(errno));
  for (const vm::Descriptor* one : {&lock, &folder}) {
    if (!one->valid() || ::flock(one->get(), LOCK_EX | LOCK_NB) == 0) continue;
    if (errno == EWOULDBLOCK) {
      return base::Error{base::Refusal::kAlreadyRunning, "a controller already runs in " + path};
    }
    // Some file systems of networks lock files only.
    if (one == &lock || read_only) return unwritable(file, std::strerror(errno));
  }
  return StateFolder(real, {std::move(lock), std::move(folder)}, *made);
}

bool holds_program(const std::string& directory) {
  std::error_code error;
  const std::filesystem::path folder(directory);
  const auto holds_any = [&](std::span<const char* const> names) {
    return std::any_of(names.begin(), names.end(), [&](const char* name) {
      return std::filesystem::exists(folder / name, error);
    });
  };
  return holds_any(online_change::kControlFiles) || holds_any(online_change::kSlotFiles) ||
         holds_any(online_change::kRetainFiles);
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
