#include "tools/common/files.h"

#include <fcntl.h>
#include <sys/auxv.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "tools/common/descriptor.h"

namespace tools {
namespace {

base::Error file_error(base::Refusal refusal, const std::string& path, int code) {
  return {refusal, path + ": " + std::strerror(code)};
}

constexpr size_t kReadStep = 64 << 10;

base::Result<Descriptor> open_to_read(const std::string& path) {
  Descriptor file{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.fd >= 0) return file;
  auto refusal = errno == ENOENT ? base::Refusal::kFileNotFound : base::Refusal::kFileUnreadable;
  return file_error(refusal, path, errno);
}

// All pages that `bytes` has room for at once: one after the other costs several times as much.
void take_pages(base::Bytes& bytes) {
#ifdef MADV_POPULATE_WRITE
  const auto begin = reinterpret_cast<uintptr_t>(bytes.data());
  const auto page = static_cast<uintptr_t>(::sysconf(_SC_PAGESIZE));
  const uintptr_t first = (begin + page - 1) / page * page;
  const uintptr_t last = (begin + bytes.capacity()) / page * page;
  if (last > first) ::madvise(reinterpret_cast<void*>(first), last - first, MADV_POPULATE_WRITE);
#else
  static_cast<void>(bytes);
#endif
}

bool replaceable(const std::string& path) {
  struct stat info;
  return ::lstat(path.c_str(), &info) != 0 || S_ISREG(info.st_mode);
}

base::Status write_through(const std::string& path, base::ByteSpan bytes) {
  Descriptor file{::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)};
  if (file.fd < 0) return file_error(base::Refusal::kFileUnwritable, path, errno);
  return write_all(file.fd, path, bytes);
}

}  // namespace

base::Status write_all(int fd, const std::string& path, base::ByteSpan bytes) {
  size_t done = 0;
  while (done < bytes.size()) {
    ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return file_error(base::Refusal::kFileUnwritable, path, errno);
    done += static_cast<size_t>(n);
  }
  return base::Ok{};
}

base::Result<base::Bytes> read_bytes(const std::string& path, uint64_t limit) {
  base::Result<Descriptor> file = open_to_read(path);
  if (!file.ok()) return file.error();
  struct stat info;
  const bool sized = ::fstat(file->fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size > 0;
  // One more, so that the end of a file is found without more room.
  const size_t step = sized ? std::min(static_cast<uint64_t>(info.st_size), limit) + 1 : kReadStep;
  base::Bytes bytes;
  bytes.reserve(step);
  if (step > kReadStep) take_pages(bytes);
  for (size_t used = 0;;) {
    if (used == bytes.size()) bytes.resize(used + (used == 0 ? step : kReadStep));
    const ssize_t n = ::read(file->fd, bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return file_error(base::Refusal::kFileUnreadable, path, errno);
    used += static_cast<size_t>(n);
    if (used > limit) {
      return base::Error{base::Refusal::kFileUnreadable,
                         path + ": larger than " + std::to_string(limit) + " bytes"};
    }
    if (n != 0) continue;
    bytes.resize(used);
    return bytes;
  }
}

base::Result<base::Bytes> read_first(const std::string& path, size_t count) {
  base::Result<Descriptor> file = open_to_read(path);
  if (!file.ok()) return file.error();
  base::Bytes bytes(count);
  ssize_t n = 0;
  do {
    n = ::read(file->fd, bytes.data(), count);
  } while (n < 0 && errno == EINTR);
  if (n < 0) return file_error(base::Refusal::kFileUnreadable, path, errno);
  bytes.resize(static_cast<size_t>(n));
  return bytes;
}

base::Result<std::string> read_text(const std::string& path, uint64_t limit) {
  base::Result<base::Bytes> bytes = read_bytes(path, limit);
  if (!bytes.ok()) return bytes.error();
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

base::Status write_file(const std::string& path, base::ByteSpan bytes) {
  if (!replaceable(path)) return write_through(path, bytes);
  std::string temporary = path + ".tmp" + std::to_string(::getpid());
  base::Status status = base::Ok{};
  {
    Descriptor file{::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666)};
    if (file.fd < 0) return file_error(base::Refusal::kFileUnwritable, path, errno);
    struct stat old;
    bool replaces = ::stat(path.c_str(), &old) == 0;
    status = write_all(file.fd, path, bytes);
    // What is replaced keeps its permissions; and it goes only when the new content is on the disk.
    bool kept = !replaces || ::fchmod(file.fd, old.st_mode & 07777) == 0;
    if (status.ok() && (!kept || ::fsync(file.fd) != 0)) {
      status = file_error(base::Refusal::kFileUnwritable, path, errno);
    }
  }
  if (status.ok() && ::rename(temporary.c_str(), path.c_str()) != 0) {
    status = file_error(base::Refusal::kFileUnwritable, path, errno);
  }
  if (!status.ok()) ::unlink(temporary.c_str());
  return status;
}

bool is_folder(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_directory(path, none);
}

bool is_file(const std::string& path) {
  std::error_code none;
  return std::filesystem::is_regular_file(path, none);
}

bool is_there(const std::string& path) {
  std::error_code none;
  return std::filesystem::exists(path, none);
}

std::string own_folder() {
  std::error_code error;
  std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) {  // nothing is mounted there: the path that this program was started by
    const auto* const started = reinterpret_cast<const char*>(getauxval(AT_EXECFN));
    self = std::filesystem::absolute(started == nullptr ? "." : started, error);
  }
  return self.parent_path().string();
}

}  // namespace tools
