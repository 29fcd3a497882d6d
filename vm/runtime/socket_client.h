// The client side of the control channel.
#pragma once

#include <memory>
#include <string>

#include "vm/runtime/descriptor.h"
#include "vm/runtime/ports.h"

namespace vm {

class SocketClient : public Transport {
 public:
  static constexpr uint32_t kPatienceSeconds = 60;  // for an answer, where nobody says otherwise
  // kNotRunning when nobody listens in `directory`.
  static base::Result<std::unique_ptr<SocketClient>> connect(
      const std::string& directory, uint32_t patience_s = kPatienceSeconds);
  // The connection alone, on behalf of this machine or of another one. kNotRunning also where
  // another user has made the socket (socket_peer.h).
  enum class For : uint8_t { kThisMachine, kAnother };
  static base::Result<Descriptor> open(const std::string& directory, For whom);
  // Over a socket that is connected already; `place` for messages: "on plc7".
  static std::unique_ptr<SocketClient> over(Descriptor socket, std::string place,
                                            uint32_t patience_s = kPatienceSeconds);
  // One framed message each way; kNotRunning when the other side goes away, says nothing for longer
  // than the patience, or takes longer from the first byte of an answer to the last; then the
  // connection is given up: what comes late would be taken for another answer. One that went away
  // while nothing was asked, as it does with idle clients, is looked for again.
  base::Result<base::Bytes> exchange(base::ByteSpan request) override;

 private:
  SocketClient(std::string place, Descriptor socket, uint32_t patience_s);
  base::Result<base::Bytes> ask(base::ByteSpan request, bool& closed);
  base::Error lost(const char* what) const;
  bool closed_meanwhile() const;

  std::string directory_;  // "": it cannot be connected again
  std::string place_;
  Descriptor socket_;
  uint32_t patience_s_;
};

}  // namespace vm
