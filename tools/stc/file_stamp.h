// What tells one content of a file from the next: the system's time of its last change, which
// nobody sets back, as copies and archives do with the time of modification.
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace stc {

struct FileStamp {
  int64_t seconds = -1;  // -1: there is no such file
  int64_t ns = 0;
  int64_t bytes = 0;
  uint64_t file = 0;
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

using Stamps = std::map<std::string, FileStamp>;  // by path

// When the file became what it is, by the system's clock; 0: there is none.
int64_t changed_ns(const std::string& path);

FileStamp stamp_of(const std::string& path);

}  // namespace stc
