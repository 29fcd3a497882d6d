// Who is at the other end of a Unix socket: both sides of the control channel talk to their own
// user and to root only, whatever the permissions of the socket's folder. Root's tools also talk to
// a service that has a user and a folder of its own.
#pragma once

#include <sys/types.h>

#include <string>

#include "base/result.h"

namespace vm {

// kNotPermitted, kForeignPeer; the user by name, or as a number. `writer`: of the socket's folder
// (SocketPlace::only_writer); 0 where nobody has made the socket who is not the other side itself.
base::Result<std::string> trusted_peer(int socket, uid_t writer = 0);
// By name, or as a number.
std::string user_name(uid_t id);
// Is `peer` root, or who asks? Or does root ask whom the folder belongs to?
bool is_trusted(uid_t peer, uid_t own, uid_t writer);

}  // namespace vm
