#include "vm/runtime/socket_server.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <cerrno>
#include <cstring>

#include "base/memory_limit.h"
#include "vm/runtime/connection.h"
#include "vm/runtime/socket_peer.h"
#include "vm/runtime/socket_place.h"

namespace vm {
namespace {

// When the system has no descriptor for a connection, the server waits before it accepts again:
// poll() would return at once, as somebody still waits.
constexpr auto kAfterFailure = std::chrono::milliseconds(100);

Descriptor spare() { return Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)); }

// The answer is sent only if the socket has room for it at once; a new socket has.
void send_away(const Descriptor& socket, const base::Error& why) {
  const base::Bytes answer = frame(encode_answer(why));
  (void)!::send(socket.get(), answer.data(), answer.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

std::vector<pollfd> poll_set(int wake, int listener, const Connections& connections) {
  std::vector<pollfd> set = {{wake, POLLIN, 0}, {listener, POLLIN, 0}};
  for (size_t i = 0; i < connections.size(); ++i) {
    set.push_back({connections[i].socket.get(), connections[i].wanted_events(), 0});
  }
  return set;
}

void wake_up(const Descriptor& wake) {
  const uint64_t one = 1;
  if (::write(wake.get(), &one, sizeof one) < 0) {
    // Full only when it has been written before: the thread wakes all the same.
  }
}

// What woke the thread is over. A thread that shall end has its flag.
void take_wake(const Descriptor& wake) {
  uint64_t count = 0;
  if (::read(wake.get(), &count, sizeof count) < 0) return;
}

bool bind_to(const Descriptor& socket, const SocketAddress& address) {
  return ::bind(socket.get(), address.get(), address.size) == 0;
}

base::Error socket_error(const std::string& path, const char* what) {
  return {base::Refusal::kFileUnwritable, path + ": " + what + ": " + std::strerror(errno)};
}

}  // namespace

base::Result<std::unique_ptr<SocketServer>> SocketServer::open(const std::string& directory,
                                                               Service& service) {
  base::Result<SocketPlace> place = SocketPlace::in(directory);
  if (!place.ok()) return place.error();
  std::string path = directory + "/" + kSocketName;
  Descriptor listener(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  Descriptor wake(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK));
  if (!listener.valid() || !wake.valid()) return socket_error(path, "socket");
  // Before bind(), so that the socket is at no instant open to others.
  if (::fchmod(listener.get(), 0600) != 0) return socket_error(path, "chmod");
  place->remove_file();
  bool bound = bind_to(listener, place->file());
  if (!bound && place->read_only()) bound = bind_to(listener, place->without_file());
  if (!bound) return socket_error(path, "bind");
  if (::listen(listener.get(), kMaxConnections) != 0) return socket_error(path, "listen");
  return std::unique_ptr<SocketServer>(
      new SocketServer(path, std::move(listener), std::move(wake), service));
}

SocketServer::SocketServer(std::string path, Descriptor listener, Descriptor wake, Service& service)
    : path_(std::move(path)),
      listener_(std::move(listener)),
      reserve_(spare()),
      wake_(std::make_shared<Descriptor>(std::move(wake))),
      service_(service) {
  service_.wake = [wakes = wake_] { wake_up(*wakes); };
  thread_ = std::thread([this] { serve(); });
}

SocketServer::~SocketServer() {
  ending_.store(true);
  wake_up(*wake_);
  thread_.join();
  ::unlink(path_.c_str());
}

// A bridge has given its end a name, other clients have none.
Descriptor SocketServer::accept_peer(bool& bridged) {
  sockaddr_un address{};
  socklen_t size = sizeof address;
  ++accepts_;
  const int fd =
      ::accept4(listener_.get(), reinterpret_cast<sockaddr*>(&address), &size, SOCK_CLOEXEC);
  const int error = errno;
  bridged = fd >= 0 && size > sizeof address.sun_family;
  errno = error;
  return Descriptor(fd);
}

// Without a descriptor for it, a newcomer gets the one in reserve; while somebody has that, the
// place of a connection as if all places were taken.
void SocketServer::take_connection(Connections& connections) {
  const Instant now = std::chrono::steady_clock::now();
  Connection next;
  next.socket = accept_peer(next.bridged);
  if (!next.socket.valid() && (errno == EMFILE || errno == ENFILE)) {
    const bool free = reserve_.valid() || connections.make_room(false, now);
    { const Descriptor given_up = std::move(reserve_); }
    if (free) next.socket = accept_peer(next.bridged);
  }
  if (!next.socket.valid()) {
    listen_again_ = now + kAfterFailure;
    return;
  }
  base::Result<std::string> user = trusted_peer(next.socket.get());
  if (!user.ok()) return send_away(next.socket, user.error());
  next.user = std::move(*user);
  if (connections.add(next, now)) return;
  send_away(next.socket,
            {base::Refusal::kBusy,
             std::to_string(kMaxConnections) +
                 " connections are in use just now; try again in a second, or end one"});
}

// Newcomers too: one of them may have something urgent.
void SocketServer::look_meanwhile(Connections& connections) {
  pollfd listener{listener_.get(), POLLIN, 0};
  if (::poll(&listener, 1, 0) > 0) take_connection(connections);
  std::vector<pollfd> set;
  for (size_t i = 0; i < connections.size(); ++i) {
    set.push_back({connections[i].socket.get(), POLLIN | POLLRDHUP, 0});
  }
  if (::poll(set.data(), set.size(), 0) <= 0) return;
  connections.attend_meanwhile(set, std::chrono::steady_clock::now());
}

// False: the thread ends.
bool SocketServer::round(Connections& connections) {
  const bool listens = std::chrono::steady_clock::now() >= listen_again_;
  std::vector<pollfd> set = poll_set(wake_->get(), listens ? listener_.get() : -1, connections);
  int wait_ms = listens ? service_.keep_up_ms() : static_cast<int>(kAfterFailure.count());
  if (connections.holds_any()) wait_ms = 0;
  if (::poll(set.data(), set.size(), wait_ms) < 0 && errno != EINTR) {
    std::this_thread::sleep_for(kAfterFailure);  // no memory; there will be some again
    return true;
  }
  if (set[0].revents != 0) take_wake(*wake_);
  const Instant now = std::chrono::steady_clock::now();
  if (!connections.attend(std::span(set).subspan(2), ending_, now)) return false;
  if (!reserve_.valid()) reserve_ = spare();
  if ((set[1].revents & POLLIN) != 0) take_connection(connections);
  service_.keep_up();
  return true;
}

void SocketServer::serve() {
  Connections connections(service_);
  service_.meanwhile = [&] { look_meanwhile(connections); };
  // When memory runs out, all connections end: the program runs on, and there is memory again.
  const auto drop_all = [&] { return connections.clear(), true; };
  const auto one_round = [&] { return round(connections); };
  while (!ending_.load() && base::within_memory(one_round, drop_all)) continue;
  service_.meanwhile = nullptr;
}

}  // namespace vm
