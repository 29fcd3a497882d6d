#include <fcntl.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>

#include "vm/runtime/socket_server.h"

namespace vm {

// A socket address holds 107 bytes. /proc/self/fd names the directory in few.
base::Result<std::string> socket_path(const std::string& directory, Descriptor& holder) {
  holder = Descriptor(::open(directory.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
  if (!holder.valid()) {
    auto refusal = errno == ENOENT ? base::Refusal::kFileNotFound : base::Refusal::kFileUnreadable;
    return base::Error{refusal, directory + ": " + std::strerror(errno)};
  }
  std::string direct = directory + "/" + kSocketName;
  if (direct.size() < sizeof(sockaddr_un{}.sun_path)) return direct;
  return "/proc/self/fd/" + std::to_string(holder.get()) + "/" + kSocketName;
}

}  // namespace vm
