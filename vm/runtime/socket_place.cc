#include "vm/runtime/socket_place.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>

#include "vm/runtime/socket_server.h"

namespace vm {

// A socket address holds 107 bytes. /proc/self/fd names the directory in few.
base::Result<SocketPlace> SocketPlace::in(const std::string& directory) {
  Descriptor holder(::open(directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!holder.valid()) {
    auto refusal = errno == ENOENT ? base::Refusal::kFileNotFound : base::Refusal::kFileUnreadable;
    return base::Error{refusal, directory + ": " + std::strerror(errno)};
  }
  std::string path = directory + "/" + kSocketName;
  if (path.size() >= sizeof(sockaddr_un{}.sun_path)) {
    path = "/proc/self/fd/" + std::to_string(holder.get()) + "/" + kSocketName;
  }
  return SocketPlace(std::move(holder), std::move(path));
}

SocketAddress SocketPlace::file() const {
  SocketAddress out;
  out.name.sun_family = AF_UNIX;
  std::memcpy(out.name.sun_path, path_.data(), path_.size());
  out.size = sizeof out.name;
  return out;
}

uid_t SocketPlace::only_writer() const {
  struct stat info {};
  const bool known = ::fstat(directory_.get(), &info) == 0;
  return known && (info.st_mode & (S_IWGRP | S_IWOTH)) == 0 ? info.st_uid : 0;
}

// The first byte of such a name is zero.
SocketAddress SocketPlace::without_file() const {
  struct stat info {};
  (void)::fstat(directory_.get(), &info);
  SocketAddress out;
  out.name.sun_family = AF_UNIX;
  const int length = std::snprintf(out.name.sun_path + 1, sizeof out.name.sun_path - 1,
                                   "stvm-%llx-%llx", static_cast<unsigned long long>(info.st_dev),
                                   static_cast<unsigned long long>(info.st_ino));
  out.size =
      static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1) + static_cast<socklen_t>(length);
  return out;
}

bool SocketPlace::read_only() const {
  struct statvfs info {};
  return ::fstatvfs(directory_.get(), &info) == 0 && (info.f_flag & ST_RDONLY) != 0;
}

void SocketPlace::remove_file() const { ::unlink(path_.c_str()); }

}  // namespace vm
