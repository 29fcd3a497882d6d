// What a service manager wants to hear (systemd's sd_notify protocol: datagrams to
// $NOTIFY_SOCKET). Without one, nothing happens.
#pragma once

#include <cstdint>
#include <string>

#include "vm/runtime/clocks.h"

namespace stvm {

class ServiceNotify {
 public:
  ServiceNotify();  // from the environment: NOTIFY_SOCKET, WATCHDOG_USEC
  ~ServiceNotify();
  ServiceNotify(const ServiceNotify&) = delete;
  ServiceNotify& operator=(const ServiceNotify&) = delete;

  void ready(const std::string& status) const;
  void stopping() const;
  // By the control loop, in each cycle and while it waits: tells that it lives, twice in the time
  // that the watchdog allows. Does not block.
  void alive();

 private:
  void send(const std::string& message) const;

  int socket_ = -1;
  std::string address_;
  int64_t interval_ns_ = 0;  // 0: nobody watches
  int64_t next_ns_ = 0;
  vm::RealClock clock_;
};

}  // namespace stvm
