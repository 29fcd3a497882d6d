// Says at once that files were saved, where the system does (Linux: inotify). It is no more than a
// hint when to look: what it misses, polling finds.
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <set>
#include <string>

namespace stc {

class FileEvents {
 public:
  using Time = std::chrono::steady_clock::time_point;

  FileEvents() = default;
  ~FileEvents() { end(); }
  FileEvents(const FileEvents&) = delete;
  FileEvents& operator=(const FileEvents&) = delete;

  // Watches the files in these folders from now on, and no others; "" is the current folder.
  // Nothing is missed in folders that it was told of before. False when it is not told of all that
  // is written there: too many folders, or a file system of a kind that others may write to (a
  // network's).
  bool watch(const std::set<std::string>& folders);
  // Readable when something has happened; -1: never.
  int descriptor() const { return events_; }
  // Files that were closed after writing, moved or deleted since the last call; nullopt: which
  // ones is not known, or there are other folders now. Files that are saved together come together:
  // it waits until nothing has happened for `quiet`, but not for ever.
  std::optional<std::set<std::string>> take(std::chrono::milliseconds quiet);
  // What has happened until now, without a wait: take() tells it, begun() and lost() know it.
  // False: nothing that take() would tell.
  bool read();
  bool has_more_to_take() const { return !known_ || !files_.empty(); }

  // Nobody pauses longer in the middle of a file: what stays open longer is complete. 5 s, or what
  // STC_PATIENCE says: where files come over a slow line.
  static std::chrono::seconds longest_pause();
  // Files that were created or written to and not closed since, and when that was seen last.
  const std::map<std::string, Time>& begun() const { return begun_; }
  // When it was seen last that more had happened than the system could tell.
  Time lost() const { return lost_; }

 private:
  void end();

  int events_ = -1;
  std::map<int, std::string> folders_;  // by watch
  std::set<std::string> files_;         // not taken yet
  bool known_ = true;                   // they are all
  std::map<std::string, Time> begun_;
  Time lost_ = Time::min();
};

}  // namespace stc
