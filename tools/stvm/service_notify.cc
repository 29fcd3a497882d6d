#include "tools/stvm/service_notify.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace stvm {

ServiceNotify::ServiceNotify() {
  const char* address = std::getenv("NOTIFY_SOCKET");
  const bool usable = address != nullptr && (address[0] == '/' || address[0] == '@') &&
                      std::string(address).size() < sizeof(sockaddr_un::sun_path);
  if (!usable) return;
  address_ = address;
  socket_ = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const char* watchdog = std::getenv("WATCHDOG_USEC");
  const char* pid = std::getenv("WATCHDOG_PID");
  const bool for_us = pid == nullptr || std::strtol(pid, nullptr, 10) == getpid();
  if (watchdog != nullptr && for_us) {
    interval_ns_ = std::clamp<int64_t>(std::strtoll(watchdog, nullptr, 10), 0, 1'000'000'000'000) *
                   500;  // half of it
  }
}

ServiceNotify::~ServiceNotify() {
  if (socket_ >= 0) close(socket_);
}

void ServiceNotify::send(const std::string& message) const {
  if (socket_ < 0) return;
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::copy(address_.begin(), address_.end(), to.sun_path);
  if (to.sun_path[0] == '@') to.sun_path[0] = '\0';  // an abstract name
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + address_.size());
  // A manager that does not listen is no reason to stop a plant.
  [[maybe_unused]] const ssize_t sent =
      sendto(socket_, message.data(), message.size(), MSG_NOSIGNAL,
             reinterpret_cast<const sockaddr*>(&to), size);
}

void ServiceNotify::ready(const std::string& status) const { send("READY=1\nSTATUS=" + status); }

void ServiceNotify::stopping() const { send("STOPPING=1"); }

void ServiceNotify::alive() {
  if (interval_ns_ == 0) return;
  const int64_t now_ns = clock_.now_ns();
  if (now_ns < next_ns_) return;
  next_ns_ = now_ns + interval_ns_;
  send("WATCHDOG=1");
}

}  // namespace stvm
