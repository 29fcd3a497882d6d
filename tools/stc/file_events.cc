#include "tools/stc/file_events.h"

#include <linux/magic.h>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <string_view>
#include <utility>

namespace stc {
namespace {

constexpr int kLongestBurst = 50;  // looks at what has happened, before somebody is told
constexpr uint32_t kPauseSeconds = 5;
constexpr uint32_t kMostPatience = 3600;

// What is written piece by piece is looked at when it is closed.
constexpr uint32_t kBegun = IN_CREATE | IN_MODIFY;
constexpr uint32_t kWanted = kBegun | IN_CLOSE_WRITE | IN_MOVED_TO | IN_MOVED_FROM | IN_DELETE |
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

std::chrono::seconds FileEvents::longest_pause() {
  static const std::chrono::seconds pause = [] {
    const char* const text = std::getenv("STC_PATIENCE");
    const std::string_view digits = text == nullptr ? "" : text;
    uint32_t seconds = 0;
    std::from_chars(digits.data(), digits.data() + digits.size(), seconds);
    return std::chrono::seconds(seconds == 0 ? kPauseSeconds : std::min(seconds, kMostPatience));
  }();
  return pause;
}

void FileEvents::end() {
  if (events_ >= 0) ::close(std::exchange(events_, -1));
}

bool FileEvents::watch(const std::set<std::string>& folders) {
  if (events_ < 0) events_ = ::inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
  if (events_ < 0) return false;
  bool all = true;
  const std::map<int, std::string> before = std::exchange(folders_, {});
  for (const std::string& folder : folders) {
    const std::string path = folder.empty() ? "." : folder;
    const int number = ::inotify_add_watch(events_, path.c_str(), kWanted);
    // One folder by two names has one watch: only one of them would be told.
    all = number >= 0 && folders_.emplace(number, folder).second && is_local(path) && all;
  }
  for (const auto& [number, folder] : before) {
    if (!folders_.contains(number)) ::inotify_rm_watch(events_, number);
  }
  return all;
}

std::optional<std::set<std::string>> FileEvents::take(std::chrono::milliseconds quiet) {
  pollfd more = {events_, POLLIN, 0};
  Time end = Time::min();
  for (int burst = 0; burst < kLongestBurst; ++burst) {
    const Time now = std::chrono::steady_clock::now();
    if (read() || burst == 0) end = now + quiet;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - now).count();
    if (left <= 0 || ::poll(&more, 1, static_cast<int>(left)) <= 0) break;
  }
  std::set<std::string> files = std::exchange(files_, {});
  if (!std::exchange(known_, true)) return std::nullopt;
  return files;
}

bool FileEvents::read() {
  bool told = false;
  const Time now = std::chrono::steady_clock::now();
  alignas(inotify_event) char buffer[16 << 10];
  for (ssize_t n; (n = ::read(events_, buffer, sizeof buffer)) > 0;) {
    for (ssize_t at = 0; at < n;) {
      inotify_event event;
      std::memcpy(&event, buffer + at, sizeof event);
      const char* const name = buffer + at + sizeof event;
      at += static_cast<ssize_t>(sizeof event + event.len);
      if ((event.mask & IN_Q_OVERFLOW) != 0) lost_ = now;
      const auto folder = folders_.find(event.wd);
      if (folder == folders_.end() && event.wd >= 0) continue;  // no longer wanted
      if (event.wd < 0 || event.len == 0 || (event.mask & kOfFolders) != 0) {
        known_ = false;
        told = true;
        continue;
      }
      std::string file = (std::filesystem::path(folder->second) / name).string();
      if ((event.mask & kBegun) != 0) {
        begun_[std::move(file)] = now;
      } else {
        begun_.erase(file);
        files_.insert(std::move(file));
        told = true;
      }
    }
  }
  std::erase_if(begun_, [&](const auto& file) { return now - file.second >= longest_pause(); });
  return told;
}

}  // namespace stc
