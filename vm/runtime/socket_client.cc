#include "vm/runtime/socket_client.h"

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "vm/runtime/frames.h"
#include "vm/runtime/protocol.h"
#include "vm/runtime/socket_peer.h"
#include "vm/runtime/socket_place.h"
#include "vm/runtime/socket_server.h"

namespace vm {
namespace {

void be_patient(const Descriptor& socket, uint32_t seconds) {
  timeval patience{static_cast<time_t>(seconds), 0};
  ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
}

// The error is that of the file, which is what people can see.
bool connect_to(const Descriptor& socket, const SocketPlace& place) {
  const SocketAddress file = place.file();
  if (::connect(socket.get(), file.get(), file.size) == 0) return true;
  const int error = errno;
  const SocketAddress other = place.without_file();
  if (place.read_only() && ::connect(socket.get(), other.get(), other.size) == 0) return true;
  errno = error;
  return false;
}

}  // namespace

base::Error SocketClient::lost(const char* what) const {
  return {base::Refusal::kNotRunning, "the controller " + place_ + " " + what};
}

SocketClient::SocketClient(std::string place, Descriptor socket, uint32_t patience_s)
    : place_(std::move(place)), socket_(std::move(socket)), patience_s_(patience_s) {
  be_patient(socket_, patience_s_);
}

base::Result<std::unique_ptr<SocketClient>> SocketClient::connect(const std::string& directory,
                                                                  uint32_t patience_s) {
  base::Result<Descriptor> socket = open(directory, For::kThisMachine);
  if (!socket.ok()) return socket.error();
  auto client = over(std::move(*socket), "in " + directory, patience_s);
  client->directory_ = directory;
  return client;
}

base::Result<Descriptor> SocketClient::open(const std::string& directory, For whom) {
  base::Result<SocketPlace> place = SocketPlace::in(directory);
  if (!place.ok()) {
    return base::Error{base::Refusal::kNotRunning,
                       "no controller runs there: " + place.error().text};
  }
  Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  // The server knows a bridge by its end having a name; the system finds one.
  if (whom == For::kAnother) {
    const SocketAddress any{{AF_UNIX, {}}, sizeof(sa_family_t)};
    (void)::bind(socket.get(), any.get(), any.size);
  }
  if (!connect_to(socket, *place)) {
    return base::Error{base::Refusal::kNotRunning,
                       "no controller runs in " + directory + ": " + std::strerror(errno)};
  }
  base::Result<std::string> peer = trusted_peer(socket.get(), place->only_writer());
  if (!peer.ok()) {
    return base::Error{base::Refusal::kNotRunning,
                       "what runs in " + directory + " is not trusted: " + peer.error().text};
  }
  return socket;
}

std::unique_ptr<SocketClient> SocketClient::over(Descriptor socket, std::string place,
                                                 uint32_t patience_s) {
  using Client = std::unique_ptr<SocketClient>;
  return Client(new SocketClient(std::move(place), std::move(socket), patience_s));
}

// There are no bytes to come before a request is sent, only an end.
bool SocketClient::closed_meanwhile() const {
  char byte = 0;
  return ::recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) == 0;
}

// One that only looks may have lost its place just before the request came (Connections).
base::Result<base::Bytes> SocketClient::exchange(base::ByteSpan request) {
  bool closed = false;
  base::Result<base::Bytes> answer = ask(request, closed);
  const bool again = closed && !directory_.empty() && !changes_state(request);
  return again ? ask(request, closed) : std::move(answer);
}

base::Result<base::Bytes> SocketClient::ask(base::ByteSpan request, bool& closed) {
  if (!directory_.empty() && closed_meanwhile()) {
    base::Result<Descriptor> again = open(directory_, For::kThisMachine);
    if (!again.ok()) return again.error();
    socket_ = std::move(*again);
    be_patient(socket_, patience_s_);
  }
  base::Bytes out = frame(request);
  for (size_t sent = 0; sent < out.size();) {
    ssize_t n = ::send(socket_.get(), out.data() + sent, out.size() - sent, MSG_NOSIGNAL);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) break;  // it may have said why before it closed the connection
    sent += static_cast<size_t>(n);
  }
  FrameReader reader;
  uint8_t buffer[65536];
  std::optional<std::chrono::steady_clock::time_point> begun;  // when the first bytes came
  const std::chrono::seconds patience(patience_s_);
  for (;;) {
    if (std::optional<base::Bytes> answer = reader.next()) return std::move(*answer);
    if (reader.broken()) {
      return base::Error{base::Refusal::kProtocol, "answer not understood: too long"};
    }
    ssize_t n = ::recv(socket_.get(), buffer, std::min(sizeof buffer, reader.room()), 0);
    if (n < 0 && errno == EINTR) continue;
    // One that says a byte now and then says nothing.
    const auto now = std::chrono::steady_clock::now();
    const bool late = n > 0 && now - begun.value_or(now) > patience;
    if (late || (n < 0 && errno == EAGAIN)) {
      socket_ = Descriptor();
      return lost("does not answer");
    }
    if (!begun) begun = now;
    closed = n <= 0;
    if (closed) return lost("closed the connection");
    reader.add({buffer, static_cast<size_t>(n)});
  }
}

}  // namespace vm
