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
  FileEvents() = default;
  ~FileEvents() { end(); }
  FileEvents(const FileEvents&) = delete;
  FileEvents& operator=(const FileEvents&) = delete;

  // Of the files in these folders from now on, and of no others; "" is the current folder. False
  // when it is not told of all that is written there: too many folders, or a file system of a kind
  // that others may write to (a network's).
  bool watch(const std::set<std::string>& folders);
  // Readable when something has happened; -1: never.
  int descriptor() const { return events_; }
  // Files that were closed behind writing, moved or deleted since the last call; nullopt: which
  // ones is not known, or there are other folders now. Files that are saved together come together:
  // it waits until nothing has happened for `quiet`, but not for ever.
  std::optional<std::set<std::string>> take(std::chrono::milliseconds quiet);
  // It has been created and was not closed behind writing when take() looked last.
  bool is_begun(const std::string& file) const { return begun_.contains(file); }

 private:
  void end();
  bool read_into(std::set<std::string>& files);

  int events_ = -1;
  std::map<int, std::string> folders_;  // by watch
  std::set<std::string> begun_;
};

}  // namespace stc
