#include "vm/runtime/socket_peer.h"

#include <pwd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace vm {

std::string user_name(uid_t id) {
  char buffer[4096];
  passwd entry{};
  passwd* found = nullptr;
  const bool known = ::getpwuid_r(id, &entry, buffer, sizeof buffer, &found) == 0 && found;
  return known ? found->pw_name : std::to_string(id);
}

bool is_trusted(uid_t peer, uid_t own, uid_t writer) {
  return peer == 0 || peer == own || (own == 0 && peer == writer);
}

base::Result<std::string> trusted_peer(int socket, uid_t writer) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) {
    return base::Error{base::Refusal::kNotPermitted, std::strerror(errno)};
  }
  if (is_trusted(peer.uid, ::geteuid(), writer)) return user_name(peer.uid);
  return base::Error{base::Refusal::kForeignPeer, "user " + user_name(peer.uid) +
                                                      " is at the socket, neither root nor " +
                                                      user_name(::geteuid())};
}

}  // namespace vm
