#include "tools/stc/file_events.h"

#include <linux/magic.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <utility>

namespace stc {
namespace {

constexpr int kLongestBurst = 50;  // looks at what has happened, before somebody is told

// What is written piece by piece is looked at when it is closed.
constexpr uint32_t kWanted = IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_CREATE | IN_DELETE |
                             IN_DELETE_SELF | IN_MOVE_SELF | IN_ONLYDIR;
constexpr uint32_t kOfFolders = IN_ISDIR | IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT | IN_IGNORED;

constexpr long kZfs = 0x2fc12fc1;  // not in linux/magic.h
constexpr long kLocal[] = {EXT4_SUPER_MAGIC,      XFS_SUPER_MAGIC,   BTRFS_SUPER_MAGIC,
                           TMPFS_MAGIC,           RAMFS_MAGIC,       F2FS_SUPER_MAGIC,
                           OVERLAYFS_SUPER_MAGIC, MSDOS_SUPER_MAGIC, kZfs};

bool is_local(const std::string& folder) {
  struct statfs found = {};
  return ::statfs(folder.c_str(), &found) == 0 &&
         std::find(std::begin(kLocal), std::end(kLocal), static_cast<long>(found.f_type)) !=
             std::end(kLocal);
}

}  // namespace

void FileEvents::end() {
  folders_.clear();
  begun_.clear();
  if (events_ >= 0) ::close(std::exchange(events_, -1));
}

bool FileEvents::watch(const std::set<std::string>& folders) {
  end();
  events_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (events_ < 0) return false;
  bool all = true;
  for (const std::string& folder : folders) {
    const std::string path = folder.empty() ? "." : folder;
    const int number = ::inotify_add_watch(events_, path.c_str(), kWanted);
    // One folder by two names has one watch: only one of them would be told.
    all = number >= 0 && folders_.emplace(number, folder).second && is_local(path) && all;
  }
  return all;
}

std::optional<std::set<std::string>> FileEvents::take(std::chrono::milliseconds quiet) {
  std::set<std::string> files;
  bool known = true;
  pollfd more = {events_, POLLIN, 0};
  for (int burst = 0; burst < kLongestBurst; ++burst) {
    known = read_into(files) && known;
    if (::poll(&more, 1, static_cast<int>(quiet.count())) <= 0) break;
  }
  if (!known) return std::nullopt;
  return files;
}

// False: more has happened than can be told by files.
bool FileEvents::read_into(std::set<std::string>& files) {
  bool known = true;
  alignas(inotify_event) char buffer[16 << 10];
  for (ssize_t n; (n = ::read(events_, buffer, sizeof buffer)) > 0;) {
    for (ssize_t at = 0; at < n;) {
      inotify_event event;
      std::memcpy(&event, buffer + at, sizeof event);
      const char* const name = buffer + at + sizeof event;
      at += static_cast<ssize_t>(sizeof event + event.len);
      const auto folder = folders_.find(event.wd);
      if (folder == folders_.end() || event.len == 0 || (event.mask & kOfFolders) != 0) {
        known = false;
        continue;
      }
      const std::string file = (std::filesystem::path(folder->second) / name).string();
      if ((event.mask & IN_CREATE) != 0) {
        begun_.insert(file);
      } else {
        begun_.erase(file);
        files.insert(file);
      }
    }
  }
  return known;
}

}  // namespace stc
