// A libmodbus context for the line that a device's settings name: not connected yet.
#pragma once

#include <modbus.h>

#include <memory>
#include <string>
#include <string_view>

#include "vm/io/driver.h"

namespace modbus {

struct FreeContext {
  void operator()(modbus_t* context) const { modbus_free(context); }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

struct HostAndPort {
  std::string host;
  std::string port;
};
// "10.0.0.5:502", "[fe80::1]:502", "press.local:502"; without a port: 502. nullopt: neither.
std::optional<HostAndPort> parse_endpoint(std::string_view text);

// kDeviceFailed.
base::Result<Context> open_tcp(const ir::Device& device);
base::Result<Context> open_rtu(const ir::Device& device);

// What errno says after a call that failed.
std::string reason();
// The same of a serial port that could not be opened, with the way out.
std::string reason_of_port();
// Did the other side answer, and say no?
bool is_exception(int error);

void set_response_timeout(modbus_t* context, int64_t ns);

}  // namespace modbus
