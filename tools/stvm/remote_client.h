// A controller on another machine: the same bytes as on its socket, over `ssh HOST stvm bridge`, so
// that keys, users and encryption are those of OpenSSH. $STVM_SSH
// names another program than ssh.
#pragma once

#include <memory>
#include <string>

#include "tools/common/child.h"
#include "vm/runtime/socket_client.h"

namespace stvm {

class RemoteClient : public vm::Transport {
 public:
  // `directory` on that machine; "": its default.
  static base::Result<std::unique_ptr<RemoteClient>> connect(
      const std::string& host, const std::string& directory,
      uint32_t patience_s = vm::SocketClient::kPatienceSeconds);
  RemoteClient(tools::ConnectedChild child, std::unique_ptr<vm::SocketClient> client)
      : child_(std::move(child)), client_(std::move(client)) {}
  // An ssh that does not answer is ended: it may still wait for a machine that is not there.
  base::Result<base::Bytes> exchange(base::ByteSpan request) override;

 private:
  tools::ConnectedChild child_;  // ends when client_, which is gone before, closes its socket
  std::unique_ptr<vm::SocketClient> client_;
};

}  // namespace stvm
