// Whole files for the tools. Writing is all or nothing: the old content stays until the new one is
// complete.
#pragma once

#include <string>

#include "base/bytes.h"
#include "base/result.h"

namespace tools {

// Errors: kFileNotFound, kFileUnreadable (also for folders, devices and files over `limit`).
base::Result<base::Bytes> read_bytes(const std::string& path, uint64_t limit = 1u << 30);
// At most so many bytes of its beginning; errors as those of read_bytes().
base::Result<base::Bytes> read_first(const std::string& path, size_t count);
base::Result<std::string> read_text(const std::string& path, uint64_t limit = 1u << 30);
// Errors: kFileUnwritable. Symbolic links and devices such as /dev/stdout are written through.
base::Status write_file(const std::string& path, base::ByteSpan bytes);
// To a file that is open; `path` is for the message. Errors: kFileUnwritable.
base::Status write_all(int fd, const std::string& path, base::ByteSpan bytes);

// What cannot be asked, such as a link that leads to itself, is none of these.
bool is_folder(const std::string& path);
bool is_file(const std::string& path);
bool is_there(const std::string& path);

// Folder of the running program, for `stc` beside `stvm`.
std::string own_folder();

}  // namespace tools
