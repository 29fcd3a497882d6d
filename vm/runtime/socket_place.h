// Where the controller of a state directory listens. That is a socket in the directory; on a file
// system that takes no new files it is one without a file, whose name says which directory is
// meant. Both ends check who the other one is (socket_peer.h), so the name may be known to all.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <string>

#include "base/result.h"
#include "vm/runtime/descriptor.h"

namespace vm {

struct SocketAddress {
  sockaddr_un name{};
  socklen_t size = 0;
  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&name); }
};

class SocketPlace {
 public:
  // kFileNotFound, kFileUnreadable: there is no such directory.
  static base::Result<SocketPlace> in(const std::string& directory);

  SocketAddress file() const;
  SocketAddress without_file() const;
  // Who alone can put a socket there, beside root: the owner of a directory that nobody else writes
  // into. 0: others can.
  uid_t only_writer() const;
  // The file system takes no new files.
  bool read_only() const;
  // Removes the file of a controller that has ended without removing it.
  void remove_file() const;

 private:
  SocketPlace(Descriptor directory, std::string path)
      : directory_(std::move(directory)), path_(std::move(path)) {}

  Descriptor directory_;
  std::string path_;  // of the socket; short enough for an address
};

}  // namespace vm
