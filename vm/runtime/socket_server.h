// The server side of the control channel: a Unix socket in the state directory, owner only, one
// thread for all connections, bounded memory for each (connection.h). It hands every message to a
// Service and sends what that answers.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "base/bytes.h"
#include "base/result.h"
#include "vm/runtime/descriptor.h"

namespace vm {

class Service {
 public:
  virtual ~Service() = default;
  // Before each answer(): the user at the other end, by name or as a number, and over which
  // connection; `bridged`: from another machine.
  virtual void asked_by(const std::string& /*user*/, uint64_t /*session*/,
                        bool /*bridged*/ = false) {}
  // Nothing more comes over it; what was kept for it can go.
  virtual void ended(uint64_t /*session*/) {}
  // On the server's thread. `keep_open` false closes the connection after the answer.
  virtual base::Bytes answer(base::ByteSpan request, bool& keep_open) = 0;
  // On the server's thread, after answers and at least as often as keep_up_ms() says.
  virtual void keep_up() {}
  virtual int keep_up_ms() const { return 1000; }

  // Set by the server, for an answer that takes long: looks, without waiting, at who has gone and
  // at what others ask. It calls both of these, and nothing else.
  std::function<void()> meanwhile;
  // Set by the server, for any thread, the control thread too: keep_up() is called at once.
  std::function<void()> wake;
  // Nobody waits for the answer at hand any more.
  virtual void asker_left() {}
  // What cannot wait for the answer at hand is answered here; nullopt: it waits.
  virtual std::optional<base::Bytes> answer_urgent(const std::string& /*user*/,
                                                   base::ByteSpan /*request*/) {
    return std::nullopt;
  }
};

class Connections;

class SocketServer {
 public:
  // `directory` must exist; a socket left by a dead controller there is replaced, so the caller
  // holds the directory's lock. `service` must outlive the server.
  static base::Result<std::unique_ptr<SocketServer>> open(const std::string& directory,
                                                          Service& service);
  // Ends the thread after the request at hand; removes the socket.
  ~SocketServer();
  // How often a connection was asked for from the system.
  uint64_t accepts() const { return accepts_.load(); }

 private:
  SocketServer(std::string path, Descriptor listener, Descriptor wake, Service& service);
  void serve();
  bool round(Connections& connections);
  void take_connection(Connections& connections);
  void look_meanwhile(Connections& connections);
  Descriptor accept_peer(bool& bridged);

  std::string path_;
  Descriptor listener_;
  Descriptor reserve_;  // given up for a peer when there is no other
  std::chrono::steady_clock::time_point listen_again_{};
  std::atomic<uint64_t> accepts_{0};
  std::shared_ptr<Descriptor> wake_;  // eventfd: the thread shall end, or keep up
  Service& service_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

inline constexpr const char* kSocketName = "control";

}  // namespace vm
