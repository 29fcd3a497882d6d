#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>

#include "adapters/modbus/request_check.h"
#include "adapters/modbus/server.h"
#include "adapters/modbus/serving.h"
#include "vm/runtime/descriptor.h"

namespace modbus {
namespace {

constexpr int64_t kHalfFrameNs = 1'000'000'000;
// When the system has no descriptor for a connection; poll() would return at once, as somebody
// still waits.
constexpr int64_t kAfterFailureNs = 100'000'000;
constexpr size_t kHeader = 6;  // up to and with the length of the rest

vm::Descriptor spare() { return vm::Descriptor(::open("/dev/null", O_RDONLY | O_CLOEXEC)); }

// "10.0.0.7:40312", "[fe80::1]:40312"
std::string name_of(const sockaddr_storage& peer, socklen_t size) {
  char host[64];
  char port[8];
  if (::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), size, host, sizeof host, port,
                    sizeof port, NI_NUMERICHOST | NI_NUMERICSERV) != 0) {
    return "somebody";
  }
  const bool brackets = peer.ss_family == AF_INET6;
  return (brackets ? "[" + std::string(host) + "]:" : std::string(host) + ":") + port;
}

// Why nobody can listen there, and what to do.
std::string way_out() {
  if (errno == EACCES) {
    return "; ports below 1024 need CAP_NET_BIND_SERVICE (the unit says how), or choose a larger "
           "one";
  }
  if (errno == EADDRINUSE) return "; another process listens there (`ss -ltnp` shows which)";
  return errno == EADDRNOTAVAIL ? "; this machine has no such address" : "";
}

class TcpServer : public Serving {
 public:
  TcpServer(const ir::Device& device, Context context)
      : Serving(device, std::move(context)),
        address_(ir::setting(device, "address")),
        most_(static_cast<size_t>(ir::number_setting(device, "clients"))) {
    modbus_set_indication_timeout(this->context(), 0, kSlowestByteUs);
  }
  void disconnect() override {
    clients_.clear();
    listener_ = vm::Descriptor();
  }
  ~TcpServer() override { modbus_set_socket(context(), -1); }  // the sockets are ours

 private:
  struct Client {
    vm::Descriptor socket;
    std::string name;
    int64_t active_ns = 0;   // last request
    int64_t half_ns = 0;     // since when it has sent half a frame; 0: it has not
    bool looked_at = false;  // in this exchange, and it has no whole frame
    bool gone = false;
  };

  base::Status listen() override {
    if (listener_.valid()) return base::Ok{};
    listener_ = vm::Descriptor(modbus_tcp_pi_listen(context(), static_cast<int>(most_)));
    if (listener_.valid()) {
      ::fcntl(listener_.get(), F_SETFL, O_NONBLOCK);
      ::fcntl(listener_.get(), F_SETFD, FD_CLOEXEC);
      return base::Ok{};
    }
    const std::string why = reason() + way_out();
    return vm::exchange_failed("listening on " + address_ + ": " + why);
  }

  base::Status serve(int64_t until_ns) override {
    for (Client& client : clients_) client.looked_at = false;
    if (!reserve_.valid()) reserve_ = spare();
    for (int64_t left = until_ns - steady_ns(); left > 0; left = until_ns - steady_ns()) {
      const bool listens = steady_ns() >= listen_again_ns_;
      std::vector<pollfd> polled{{listens ? listener_.get() : -1, POLLIN, 0}};
      for (const Client& client : clients_) {
        polled.push_back({client.looked_at ? -1 : client.socket.get(), POLLIN, 0});
      }
      const int ready =
          ::poll(polled.data(), polled.size(), static_cast<int>(left / 1'000'000 + 1));
      if (ready < 0 && errno != EINTR) return vm::exchange_failed("poll: " + reason());
      if (ready <= 0) continue;
      for (size_t i = 0; i < clients_.size(); ++i) {
        if (polled[i + 1].revents != 0) look_at(clients_[i]);
      }
      std::erase_if(clients_, [](const Client& client) { return client.gone; });
      if (polled[0].revents != 0) accept();
    }
    return base::Ok{};
  }

  vm::Descriptor accept_from(sockaddr_storage& peer, socklen_t& size) const {
    size = sizeof peer;
    return vm::Descriptor(::accept4(listener_.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                                    SOCK_CLOEXEC));
  }

  // When there are too many, whoever has been silent longest makes room. Where the process has no
  // descriptors left, one was kept for the first who comes.
  void accept() {
    sockaddr_storage peer{};
    socklen_t size = 0;
    vm::Descriptor socket = accept_from(peer, size);
    if (!socket.valid() && (errno == EMFILE || errno == ENFILE) && reserve_.valid()) {
      { const vm::Descriptor given_up = std::move(reserve_); }
      socket = accept_from(peer, size);
    }
    if (!socket.valid()) {
      const bool gone = errno == EAGAIN || errno == ECONNABORTED || errno == EINTR;
      if (!gone) listen_again_ns_ = steady_ns() + kAfterFailureNs;
      return;
    }
    const timeval patience{0, 100'000};
    const int on = 1;
    ::setsockopt(socket.get(), SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (clients_.size() >= most_) {
      clients_.erase(std::min_element(
          clients_.begin(), clients_.end(),
          [](const Client& a, const Client& b) { return a.active_ns < b.active_ns; }));
    }
    Client& client = clients_.emplace_back();
    client.socket = std::move(socket);
    client.name = name_of(peer, size);
    client.active_ns = steady_ns();
  }

  // Length of the frame that waits there; 0: not whole yet; -1: it is none.
  int waiting_frame(Client& client) const {
    uint8_t head[MODBUS_TCP_MAX_ADU_LENGTH];
    const ssize_t got = ::recv(client.socket.get(), head, sizeof head, MSG_PEEK | MSG_DONTWAIT);
    if (got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR)) return -1;
    if (got < static_cast<ssize_t>(kHeader)) return 0;
    const int rest = head[4] << 8 | head[5];
    if (head[2] != 0 || head[3] != 0 || rest < 2) return -1;
    const int length = static_cast<int>(kHeader) + rest;
    if (length > MODBUS_TCP_MAX_ADU_LENGTH) return -1;
    return got < length ? 0 : length;
  }

  // The answer has the header of the request, but for the length.
  static bool send_answer(const Client& client, base::ByteSpan header, base::ByteSpan pdu) {
    base::Bytes out(header.begin(), header.end());
    out[kHeader - 1] = static_cast<uint8_t>(1 + pdu.size());  // the unit, too
    out[kHeader - 2] = 0;
    out.insert(out.end(), pdu.begin(), pdu.end());
    const ssize_t sent = ::send(client.socket.get(), out.data(), out.size(), MSG_NOSIGNAL);
    return sent == static_cast<ssize_t>(out.size());
  }

  bool answer_frame(Client& client, size_t length) {
    uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
    const ssize_t got = ::recv(client.socket.get(), request, length, MSG_DONTWAIT);
    if (got != static_cast<ssize_t>(length)) return false;
    const base::ByteSpan pdu(request + kHeader + 1, length - kHeader - 1);
    if (asks_who(pdu)) {
      return send_answer(client, {request, kHeader + 1}, who_it_is(pdu));
    }
    modbus_set_socket(context(), client.socket.get());
    return answer(request, static_cast<int>(length), client.name);
  }

  void look_at(Client& client) {
    const int length = waiting_frame(client);
    if (length == 0) {
      client.looked_at = true;
      if (client.half_ns == 0) client.half_ns = steady_ns();
      client.gone = steady_ns() - client.half_ns > kHalfFrameNs;
      return;
    }
    client.half_ns = 0;
    client.active_ns = steady_ns();
    client.gone = length < 0 || !answer_frame(client, static_cast<size_t>(length));
  }

  const std::string address_;
  const size_t most_;
  vm::Descriptor listener_;
  vm::Descriptor reserve_ = spare();
  int64_t listen_again_ns_ = 0;
  std::vector<Client> clients_;
};

}  // namespace

base::Result<std::unique_ptr<vm::IoDriver>> make_tcp_server(const ir::Device& device,
                                                            Context context) {
  auto server = std::make_unique<TcpServer>(device, std::move(context));
  if (!server->ok()) return base::Error{base::Refusal::kDeviceFailed, "out of memory"};
  return std::unique_ptr<vm::IoDriver>(std::move(server));
}

}  // namespace modbus
