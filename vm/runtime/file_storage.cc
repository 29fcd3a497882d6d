#include "vm/runtime/file_storage.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

namespace vm {
namespace {

base::Error failed(base::Refusal refusal, const std::string& path, int code) {
  return {refusal, path + ": " + std::strerror(code)};
}

base::Refusal unread(int code) {
  return code == ENOENT ? base::Refusal::kFileNotFound : base::Refusal::kFileUnreadable;
}

bool allowed(char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; }

// 0 or errno.
int write_all(int fd, uint64_t offset, base::ByteSpan bytes) {
  while (!bytes.empty()) {
    ssize_t n = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    if (n == 0) return EIO;
    offset += static_cast<uint64_t>(n);
    bytes = bytes.subspan(static_cast<size_t>(n));
  }
  return 0;
}

constexpr int kSafely = O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW;
constexpr const char* kFresh = "_new";  // after the name, until it has its place

}  // namespace

FileStorage::FileStorage(std::string directory, int folder)
    : directory_(std::move(directory)),
      folder_(folder >= 0 ? ::fcntl(folder, F_DUPFD_CLOEXEC, 0)
                          : ::open(directory_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)),
      folder_code_(folder_.valid() ? 0 : errno) {}

base::Status FileStorage::sync_folder() const {
  if (::fsync(folder_.get()) == 0) return base::Ok{};
  return failed(base::Refusal::kFileUnwritable, directory_, errno);
}

base::Status FileStorage::in_place(base::Refusal refusal) const {
  struct stat there {};
  struct stat opened {};
  if (::stat(directory_.c_str(), &there) != 0) return failed(refusal, directory_, errno);
  if (::fstat(folder_.get(), &opened) != 0) return failed(refusal, directory_, folder_code_);
  if (opened.st_dev == there.st_dev && opened.st_ino == there.st_ino) return base::Ok{};
  const char* const text =
      ": another folder is there now, where nothing is written; move the one before back, or stop "
      "the controller and start it with this one";
  return base::Error{refusal, directory_ + text};
}

base::Result<std::string> FileStorage::path(std::string_view name) const {
  if (name.empty() || !std::all_of(name.begin(), name.end(), allowed)) {
    return base::Error{base::Refusal::kInternal, "file name `" + std::string(name) + "`"};
  }
  return directory_ + "/" + std::string(name);
}

base::Result<FileStorage::File> FileStorage::take(const std::string& path, bool create,
                                                  bool& created) const {
  created = false;
  const int folder = folder_.get();
  const char* const name = in_folder(path);
  Descriptor descriptor;
  int code = ENOENT;
  if (create) {
    descriptor = Descriptor(::openat(folder, name, O_RDWR | kSafely));
    if (!descriptor.valid()) code = errno;
    if (code == ENOENT && !descriptor.valid()) {
      descriptor = Descriptor(::openat(folder, name, O_RDWR | O_CREAT | O_EXCL | kSafely, 0600));
      created = descriptor.valid();
      if (!created) return failed(base::Refusal::kFileUnwritable, path, errno);
    }
  }
  const bool writable = descriptor.valid();
  if (!writable) descriptor = Descriptor(::openat(folder, name, O_RDONLY | kSafely));
  struct stat info {};
  if (!descriptor.valid() || ::fstat(descriptor.get(), &info) != 0) {
    return failed(unread(errno), path, errno);
  }
  if (!S_ISREG(info.st_mode)) {
    return base::Error{base::Refusal::kFileUnreadable, path + ": not a file"};
  }
  return File{std::move(descriptor), static_cast<uint64_t>(info.st_size), writable, code, false};
}

base::Status FileStorage::allocate(File& file, const std::string& path, uint64_t size) const {
  if (file.size >= size) return base::Ok{};
  int code = ::posix_fallocate(file.descriptor.get(), 0, static_cast<off_t>(size));
  if (code == 0 && ::fsync(file.descriptor.get()) != 0) code = errno;
  if (code != 0) return failed(base::Refusal::kFileUnwritable, path, code);
  file.size = size;
  return base::Ok{};
}

base::Status FileStorage::settle_names() {
  std::lock_guard lock(mutex_);
  if (names_settled_) return base::Ok{};
  base::Status settled = sync_folder();
  names_settled_ = settled.ok();
  return settled;
}

// A name is durable only when its directory is.
base::Status FileStorage::open(std::string_view name, uint64_t size) {
  base::Result<std::string> file_path = path(name);
  if (!file_path.ok()) return file_path.error();
  base::Status placed = in_place(base::Refusal::kFileUnwritable);
  if (!placed.ok()) return placed;
  const File* const before = find(name);
  // What a process that was killed in the middle of replace() has left.
  if (before == nullptr) ::unlinkat(folder_.get(), in_folder(*file_path + kFresh), 0);
  bool created = false;
  base::Result<File> file = take(*file_path, true, created);
  if (!file.ok()) return file.error();
  const bool writable = file->writable;
  file->known = before != nullptr || created;
  base::Status done = writable ? allocate(*file, *file_path, size) : base::Ok{};
  if (!done.ok() && created) ::unlinkat(folder_.get(), in_folder(*file_path), 0);
  if (!done.ok()) return done;
  keep(name, std::move(*file));
  if (!writable) return failed(base::Refusal::kFileUnwritable, *file_path, file->refused);
  base::Status named = created ? sync_folder() : base::Ok{};
  return named.ok() ? settle_names() : named;
}

FileStorage::File* FileStorage::find(std::string_view name) {
  std::lock_guard lock(mutex_);
  const auto found = files_.find(name);
  return found == files_.end() ? nullptr : &found->second;
}

const FileStorage::File* FileStorage::keep(std::string_view name, File file) {
  std::lock_guard lock(mutex_);
  File& kept = files_[std::string(name)];
  kept = std::move(file);
  return &kept;
}

base::Result<const FileStorage::File*> FileStorage::readable(std::string_view name) {
  if (const File* open = find(name)) return open;
  base::Result<std::string> file_path = path(name);
  if (!file_path.ok()) return file_path.error();
  if (!folder_.valid()) return failed(unread(folder_code_), *file_path, folder_code_);
  bool created = false;
  base::Result<File> file = take(*file_path, false, created);
  if (!file.ok()) return file.error();
  return keep(name, std::move(*file));
}

base::Result<uint64_t> FileStorage::size(std::string_view name) {
  base::Result<const File*> file = readable(name);
  if (!file.ok()) return file.error();
  return (*file)->size;
}

base::Result<base::Bytes> FileStorage::read(std::string_view name, uint64_t offset, uint64_t size) {
  base::Result<const File*> found = readable(name);
  if (!found.ok()) return found.error();
  const File& file = **found;
  base::Bytes bytes(offset < file.size ? std::min(size, file.size - offset) : 0);
  size_t done = 0;
  while (done < bytes.size()) {
    ssize_t n = ::pread(file.descriptor.get(), bytes.data() + done, bytes.size() - done,
                        static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return failed(base::Refusal::kFileUnreadable, *path(name), errno);
    if (n == 0) break;  // became shorter meanwhile
    done += static_cast<size_t>(n);
  }
  bytes.resize(done);
  return bytes;
}

base::Status FileStorage::write(std::string_view name, uint64_t offset, base::ByteSpan bytes) {
  const File* const found = find(name);
  if (found == nullptr || !found->writable) {
    const int code = found == nullptr ? EBADF : found->refused;
    return failed(base::Refusal::kFileUnwritable, std::string(name), code);
  }
  const File& file = *found;
  if (offset > file.size || bytes.size() > file.size - offset) {
    return failed(base::Refusal::kFileUnwritable, *path(name), EFBIG);
  }
  int code = write_all(file.descriptor.get(), offset, bytes);
  if (code != 0) return failed(base::Refusal::kFileUnwritable, *path(name), code);
  return base::Ok{};
}

// A sync that has failed is not tried again. Linux drops the pages that it could not write, still
// shows them to reads, and reports success the next time. So before a file of an earlier process is
// read, its cached pages are dropped, and reads ask the disk.
base::Status FileStorage::sync(std::string_view name) {
  File* const file = find(name);
  if (file == nullptr) return failed(base::Refusal::kFileUnwritable, std::string(name), EBADF);
  const int fd = file->descriptor.get();
  if (::fdatasync(fd) != 0) return failed(base::Refusal::kFileUnwritable, *path(name), errno);
  if (!file->known) ::posix_fadvise(fd, 0, 0, POSIX_FADV_DONTNEED);
  file->known = true;
  return check(name);
}

base::Status FileStorage::check(std::string_view name) {
  const std::string file_path = *path(name);
  struct stat there {};
  const int code = ::lstat(file_path.c_str(), &there) == 0 ? 0 : errno;
  if (code != 0 && code != ENOENT) return failed(base::Refusal::kFileUnreadable, file_path, code);
  base::Status placed = in_place(base::Refusal::kFileNotFound);
  if (!placed.ok()) return placed;
  if (code != 0) {
    return base::Error{base::Refusal::kFileNotFound, file_path + ": the file was removed"};
  }
  const File* const found = find(name);
  struct stat opened {};
  if (found == nullptr) return failed(base::Refusal::kFileUnreadable, file_path, EBADF);
  if (::fstat(found->descriptor.get(), &opened) != 0) {
    return failed(base::Refusal::kFileUnreadable, file_path, errno);
  }
  if (opened.st_dev != there.st_dev || opened.st_ino != there.st_ino) {
    return base::Error{base::Refusal::kFileNotFound, file_path + ": another file is there now"};
  }
  if (static_cast<uint64_t>(opened.st_size) >= found->size) return base::Ok{};
  return base::Error{base::Refusal::kFileNotFound, file_path + ": the file became shorter"};
}

base::Status FileStorage::write_new(const std::string& path, uint64_t size,
                                    std::span<const Piece> pieces, File& file) const {
  const char* const name = in_folder(path);
  ::unlinkat(folder_.get(), name, 0);
  Descriptor descriptor(::openat(folder_.get(), name, O_RDWR | O_CREAT | O_EXCL | kSafely, 0600));
  if (!descriptor.valid()) return failed(base::Refusal::kFileUnwritable, path, errno);
  file = {.descriptor = std::move(descriptor), .writable = true, .known = true};
  base::Status made = allocate(file, path, size);
  if (!made.ok()) return made;
  int code = 0;
  for (const Piece& piece : pieces) {
    if (code == 0) code = write_all(file.descriptor.get(), piece.offset, piece.bytes);
  }
  if (code == 0 && ::fsync(file.descriptor.get()) != 0) code = errno;
  if (code != 0) return failed(base::Refusal::kFileUnwritable, path, code);
  return base::Ok{};
}

base::Status FileStorage::replace(std::string_view name, uint64_t size,
                                  std::span<const Piece> pieces) {
  base::Result<std::string> file_path = path(name);
  if (!file_path.ok()) return file_path.error();
  const std::string fresh = *file_path + kFresh;
  const int folder = folder_.get();
  File file;
  base::Status made = in_place(base::Refusal::kFileUnwritable);
  if (!made.ok()) return made;
  made = write_new(fresh, size, pieces, file);
  if (made.ok() && ::renameat(folder, in_folder(fresh), folder, in_folder(*file_path)) != 0) {
    made = failed(base::Refusal::kFileUnwritable, *file_path, errno);
  }
  if (!made.ok()) {
    ::unlinkat(folder, in_folder(fresh), 0);
    return made;
  }
  keep(name, std::move(file));
  base::Status named = sync_folder();
  return named.ok() ? check(name) : named;
}

}  // namespace vm
