// Storage in the files of one directory, which must exist. Files are allocated when they are
// opened, so a full disk is found then and not in the middle of a record.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "vm/runtime/descriptor.h"
#include "vm/runtime/ports.h"

namespace vm {

// Threads may use it at once, but not the same file.
class FileStorage : public Storage {
 public:
  // `folder` is the directory, opened; without it, what is there now is opened. Nothing is written
  // into another one that takes its place later.
  explicit FileStorage(std::string directory, int folder = -1);

  // kFileUnwritable, kFileUnreadable. A file that cannot be written can be read after the error.
  base::Status open(std::string_view name, uint64_t size) override;
  base::Result<uint64_t> size(std::string_view name) override;
  base::Result<base::Bytes> read(std::string_view name, uint64_t offset, uint64_t size) override;
  base::Status write(std::string_view name, uint64_t offset, base::ByteSpan bytes) override;
  base::Status sync(std::string_view name) override;
  base::Status replace(std::string_view name, uint64_t size,
                       std::span<const Piece> pieces) override;
  base::Status check(std::string_view name) override;

 private:
  struct File {
    Descriptor descriptor;
    uint64_t size = 0;
    bool writable = false;
    int refused = 0;     // the error by which it is not
    bool known = false;  // what reads see is what the disk holds, as far as this process can tell
  };

  // Names are lower-case letters, digits and `_`: no file lies outside the directory.
  base::Result<std::string> path(std::string_view name) const;
  // What path() gave, from the folder.
  const char* in_folder(const std::string& path) const {
    return path.c_str() + directory_.size() + 1;
  }
  // The folder is still where it was.
  base::Status in_place(base::Refusal refusal) const;
  base::Status sync_folder() const;
  base::Result<File> take(const std::string& path, bool create, bool& created) const;
  base::Status allocate(File& file, const std::string& path, uint64_t size) const;
  // What the process before has renamed is durable before anything is built on it.
  base::Status settle_names();
  base::Status write_new(const std::string& path, uint64_t size, std::span<const Piece> pieces,
                         File& file) const;
  // Null: it is not open. What it points to stays until the file is opened again.
  File* find(std::string_view name);
  const File* keep(std::string_view name, File file);
  // One that is open already, or is opened for reading only.
  base::Result<const File*> readable(std::string_view name);

  std::string directory_;
  Descriptor folder_;
  int folder_code_ = 0;  // why there is none
  std::mutex mutex_;     // of the map and the flag alone
  bool names_settled_ = false;
  std::map<std::string, File, std::less<>> files_;
};

}  // namespace vm
