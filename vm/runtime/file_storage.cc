#include "vm/runtime/file_storage.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "vm/runtime/descriptor.h"

namespace vm {
namespace {

base::Error failed(base::Refusal refusal, const std::string& path, int code) {
  return {refusal, path + ": " + std::strerror(code)};
}

bool allowed(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }

// 0 or errno.
int write_all(int fd, base::ByteSpan bytes) {
  while (!bytes.empty()) {
    ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
  return 0;
}

// A failed fsync is not tried again: what it lost is lost.
int write_durably(const std::string& path, base::ByteSpan bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
  if (!file.valid()) return errno;
  if (int code = write_all(file.get(), bytes); code != 0) return code;
  return ::fsync(file.get()) == 0 ? 0 : errno;
}

int sync_directory(const std::string& path) {
  Descriptor directory(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!directory.valid()) return errno;
  return ::fsync(directory.get()) == 0 ? 0 : errno;
}

}  // namespace

base::Result<std::string> FileStorage::path(std::string_view name) const {
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed)) {
    return base::Error{base::Refusal::kInternal, "record name `" + std::string(name) + "`"};
  }
  return directory_ + "/" + std::string(name);
}

base::Result<base::Bytes> FileStorage::read(std::string_view name) {
  base::Result<std::string> file_path = path(name);
  if (!file_path.ok()) return file_path.error();
  Descriptor file(::open(file_path->c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  struct stat info {};
  if (!file.valid() || ::fstat(file.get(), &info) != 0) {
    auto refusal = errno == ENOENT ? base::Refusal::kFileNotFound : base::Refusal::kFileUnreadable;
    return failed(refusal, *file_path, errno);
  }
  if (!S_ISREG(info.st_mode)) {
    return base::Error{base::Refusal::kFileUnreadable, *file_path + ": not a file"};
  }
  auto size = static_cast<uint64_t>(info.st_size);
  if (size > limit_) {
    return base::Error{
        base::Refusal::kFileUnreadable,
        *file_path + ": " + std::to_string(size) + " bytes, more than " + std::to_string(limit_)};
  }
  base::Bytes bytes(size);
  size_t done = 0;
  while (done < bytes.size()) {
    ssize_t n = ::read(file.get(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return failed(base::Refusal::kFileUnreadable, *file_path, errno);
    if (n == 0) break;  // became shorter meanwhile
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

base::Status FileStorage::write(std::string_view name, base::ByteSpan bytes) {
  base::Result<std::string> file_path = path(name);
  if (!file_path.ok()) return file_path.error();
  std::string temporary = *file_path + ".tmp";
  int code = write_durably(temporary, bytes);
  if (code == 0 && std::rename(temporary.c_str(), file_path->c_str()) != 0) code = errno;
  if (code != 0) {
    ::unlink(temporary.c_str());
    return failed(base::Refusal::kFileUnwritable, *file_path, code);
  }
  code = sync_directory(directory_);
  if (code != 0) return failed(base::Refusal::kFileUnwritable, directory_, code);
  return base::Ok{};
}

bool FileStorage::exists(std::string_view name) {
  base::Result<std::string> file_path = path(name);
  return file_path.ok() && ::access(file_path->c_str(), F_OK) == 0;
}

}  // namespace vm
