// Records as files of one directory. A record is replaced by a complete new file that is on disk
// before it takes the name; after any failure the old record is there as it was.
#pragma once

#include <string>

#include "vm/runtime/ports.h"

namespace vm {

class FileStorage : public Storage {
 public:
  // The directory must exist. Records over `limit` bytes are not read.
  explicit FileStorage(std::string directory, uint64_t limit = 1u << 30)
      : directory_(std::move(directory)), limit_(limit) {}

  // kFileNotFound, kFileUnreadable.
  base::Result<base::Bytes> read(std::string_view name) override;
  // kFileUnwritable.
  base::Status write(std::string_view name, base::ByteSpan bytes) override;
  bool exists(std::string_view name) override;

 private:
  // Names are lower-case letters, digits and `_`: no record lies outside the directory.
  base::Result<std::string> path(std::string_view name) const;

  std::string directory_;
  uint64_t limit_;
};

}  // namespace vm
