// Who is at the other end of a Unix socket: both sides of the control channel talk to their own
// user and to root only, whatever the permissions of the socket's folder.
#pragma once

#include <sys/types.h>

#include <string>

#include "base/result.h"

namespace vm {

// kNotPermitted; the user by name, or as a number.
base::Result<std::string> trusted_peer(int socket);
// By name, or as a number.
std::string user_name(uid_t id);
// Is `peer` root, or who asks?
bool is_trusted(uid_t peer, uid_t own);

}  // namespace vm
