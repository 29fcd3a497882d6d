#include "adapters/modbus/line.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <optional>

namespace modbus {
namespace {

base::Error failed(const std::string& text) { return {base::Refusal::kDeviceFailed, text}; }

}  // namespace

std::optional<HostAndPort> parse_endpoint(std::string_view text) {
  HostAndPort out{"", "502"};
  std::string_view rest;
  if (text.starts_with('[')) {
    const size_t end = text.find(']');
    if (end == std::string_view::npos) return std::nullopt;
    out.host = text.substr(1, end - 1);
    rest = text.substr(end + 1);
  } else {
    const size_t colon = std::min(text.find(':'), text.size());
    out.host = text.substr(0, colon);
    rest = text.substr(colon);
  }
  if (out.host.empty()) return std::nullopt;
  if (rest.empty()) return out;
  unsigned port = 0;
  const auto [end, code] = std::from_chars(rest.data() + 1, rest.data() + rest.size(), port);
  const bool whole = code == std::errc() && end == rest.data() + rest.size();
  if (rest[0] != ':' || !whole || port == 0 || port > 65535) return std::nullopt;
  out.port = rest.substr(1);
  return out;
}

base::Result<Context> open_tcp(const ir::Device& device) {
  const std::string address = ir::setting(device, "address");
  const std::optional<HostAndPort> endpoint = parse_endpoint(address);
  if (!endpoint) return failed("`" + address + "` is no address: 10.0.0.5:502, [fe80::1]:502");
  Context context(modbus_new_tcp_pi(endpoint->host.c_str(), endpoint->port.c_str()));
  if (!context) return failed("`" + address + "`: " + reason());
  return context;
}

base::Result<Context> open_rtu(const ir::Device& device) {
  const std::string parity = ir::setting(device, "parity");
  Context context(modbus_new_rtu(ir::setting(device, "port").c_str(),
                                 static_cast<int>(ir::number_setting(device, "baud")),
                                 parity == "none"   ? 'N'
                                 : parity == "even" ? 'E'
                                                    : 'O',
                                 8, static_cast<int>(ir::number_setting(device, "stop_bits"))));
  if (!context) return failed("`" + ir::setting(device, "port") + "`: " + reason());
  return context;
}

std::string reason() { return modbus_strerror(errno); }

std::string reason_of_port() {
  const int error = errno;
  const std::string why = modbus_strerror(error);
  if (error == EACCES) {
    return why +
           "; the user of the controller needs the group of that port (SupplementaryGroups "
           "in the unit, often `dialout`)";
  }
  if (error == EPERM) return why + "; the unit does not allow that port (DeviceAllow)";
  if (error == EBUSY) return why + "; another process has that port";
  return error == ENOENT ? why + "; is the adapter plugged in (`ls /dev/serial/by-id`)?" : why;
}

bool is_exception(int error) { return error > MODBUS_ENOBASE && error <= EMBXGTAR; }

void set_response_timeout(modbus_t* context, int64_t ns) {
  const int64_t us = std::max<int64_t>(ns / 1000, 1);
  modbus_set_response_timeout(context, static_cast<uint32_t>(us / 1'000'000),
                              static_cast<uint32_t>(us % 1'000'000));
}

}  // namespace modbus
