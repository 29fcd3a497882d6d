#include "vm/runtime/socket_server.h"

#include <poll.h>
#include <pwd.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <optional>

#include "base/memory_limit.h"
#include "vm/runtime/frames.h"

namespace vm {
namespace {

using Instant = std::chrono::steady_clock::time_point;

constexpr size_t kMaxConnections = 16;
// A peer that stops in the middle of a message or does not read its answer is sent away.
constexpr auto kPatience = std::chrono::seconds(10);

struct Connection {
  Descriptor socket;
  std::string user;
  FrameReader in;
  base::Bytes out;
  size_t sent = 0;
  bool closing = false;
  Instant active = std::chrono::steady_clock::now();

  bool sending() const { return sent < out.size(); }
  bool waiting_for_peer() const { return sending() || !in.empty(); }
};

// False when the peer is gone.
bool receive(Connection& connection) {
  uint8_t buffer[16384];
  size_t room = std::min(sizeof buffer, connection.in.room());
  ssize_t n = ::recv(connection.socket.get(), buffer, room, MSG_DONTWAIT);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  if (n == 0) return false;
  connection.in.add({buffer, static_cast<size_t>(n)});
  connection.active = std::chrono::steady_clock::now();
  return true;
}

bool send_rest(Connection& connection) {
  ssize_t n = ::send(connection.socket.get(), connection.out.data() + connection.sent,
                     connection.out.size() - connection.sent, MSG_DONTWAIT | MSG_NOSIGNAL);
  if (n < 0) return errno == EAGAIN || errno == EINTR;
  connection.sent += static_cast<size_t>(n);
  connection.active = std::chrono::steady_clock::now();
  return true;
}

void put_answer(Connection& connection, base::ByteSpan answer, bool keep_open) {
  connection.out = frame(answer);
  connection.sent = 0;
  connection.closing = !keep_open;
}

// Answers the next complete message; false when there is none.
bool answer_next(Connection& connection, Service& service) {
  if (connection.sending() || connection.closing) return false;
  if (std::optional<base::Bytes> request = connection.in.next()) {
    bool keep_open = true;
    service.asked_by(connection.user);
    base::Bytes answer = service.answer(*request, keep_open);
    put_answer(connection, answer, keep_open);
    return true;
  }
  if (!connection.in.broken()) return false;
  base::Error error{base::Refusal::kProtocol, "message not understood: too long"};
  put_answer(connection, encode_answer(error), false);
  return true;
}

// One round for a connection; false ends it.
bool attend(Connection& connection, short events, Service& service) {
  if ((events & (POLLERR | POLLNVAL)) != 0) return false;
  if ((events & (POLLIN | POLLHUP)) != 0 && !connection.sending() && !receive(connection)) {
    return false;
  }
  do {
    if (connection.sending() && !send_rest(connection)) return false;
  } while (answer_next(connection, service));
  if (!connection.sending() && connection.closing) return false;
  auto idle = std::chrono::steady_clock::now() - connection.active;
  return !(connection.waiting_for_peer() && idle > kPatience);
}

std::optional<uid_t> peer_of(int socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (::getsockopt(socket, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return std::nullopt;
  return peer.uid;
}

std::string user_name(uid_t id) {
  char buffer[4096];
  passwd entry{};
  passwd* found = nullptr;
  const bool known = ::getpwuid_r(id, &entry, buffer, sizeof buffer, &found) == 0 && found;
  return known ? found->pw_name : std::to_string(id);
}

void take_connection(int listener, std::vector<Connection>& connections) {
  Descriptor socket(::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC));
  if (!socket.valid()) return;
  const std::optional<uid_t> peer = peer_of(socket.get());
  if (!peer || (*peer != ::geteuid() && *peer != 0)) return;
  if (connections.size() >= kMaxConnections) return;
  Connection connection;
  connection.socket = std::move(socket);
  connection.user = user_name(*peer);
  connections.push_back(std::move(connection));
}

std::vector<pollfd> poll_set(int wake, int listener, const std::vector<Connection>& connections) {
  std::vector<pollfd> set = {{wake, POLLIN, 0}, {listener, POLLIN, 0}};
  for (const Connection& connection : connections) {
    short events = connection.sending() ? POLLOUT : POLLIN;
    set.push_back({connection.socket.get(), events, 0});
  }
  return set;
}

base::Error socket_error(const std::string& path, const char* what) {
  return {base::Refusal::kFileUnwritable, path + ": " + what + ": " + std::strerror(errno)};
}

}  // namespace

base::Result<std::unique_ptr<SocketServer>> SocketServer::open(const std::string& directory,
                                                               Service& service) {
  Descriptor holder;
  base::Result<std::string> address_path = socket_path(directory, holder);
  if (!address_path.ok()) return address_path.error();
  std::string path = directory + "/" + kSocketName;
  Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  Descriptor wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!listener.valid() || !wake.valid()) return socket_error(path, "socket");
  // Before bind(), so that the socket is at no instant open to others.
  if (::fchmod(listener.get(), 0600) != 0) return socket_error(path, "chmod");
  ::unlink(address_path->c_str());
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, address_path->data(), address_path->size());
  if (::bind(listener.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    return socket_error(path, "bind");
  }
  if (::listen(listener.get(), kMaxConnections) != 0) return socket_error(path, "listen");
  return std::unique_ptr<SocketServer>(
      new SocketServer(path, std::move(listener), std::move(wake), service));
}

SocketServer::SocketServer(std::string path, Descriptor listener, Descriptor wake, Service& service)
    : path_(std::move(path)),
      listener_(std::move(listener)),
      wake_(std::move(wake)),
      service_(service),
      thread_([this] { serve(); }) {}

SocketServer::~SocketServer() {
  ending_.store(true);
  uint64_t one = 1;
  if (::write(wake_.get(), &one, sizeof one) < 0) {
    // Full only when it has been written before: the thread wakes all the same.
  }
  thread_.join();
  ::unlink(path_.c_str());
}

void SocketServer::serve() {
  std::vector<Connection> connections;
  const auto round = [&] {  // false: the thread ends
    std::vector<pollfd> set = poll_set(wake_.get(), listener_.get(), connections);
    if (::poll(set.data(), set.size(), 1000) < 0 && errno != EINTR) return false;
    for (size_t i = connections.size(); i-- > 0;) {
      if (ending_.load()) return false;
      if (!attend(connections[i], set[i + 2].revents, service_)) {
        connections.erase(connections.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
    if ((set[1].revents & POLLIN) != 0) take_connection(listener_.get(), connections);
    service_.keep_up();
    return true;
  };
  // When memory runs out, all connections end: the program runs on, and there is memory again.
  const auto drop_all = [&] { return connections.clear(), true; };
  while (!ending_.load() && base::within_memory(round, drop_all)) continue;
}

}  // namespace vm
