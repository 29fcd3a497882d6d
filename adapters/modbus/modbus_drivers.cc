#include "adapters/modbus/modbus_drivers.h"

#include "adapters/modbus/client.h"
#include "adapters/modbus/server.h"

namespace modbus {

base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device) {
  const ir::DriverRow* row = ir::find_driver(device.driver);
  const bool tcp = row->id == ir::DriverId::kModbusTcp || row->id == ir::DriverId::kModbusTcpServer;
  base::Result<Context> context = tcp ? open_tcp(device) : open_rtu(device);
  if (!context.ok()) return context.error();
  if (!row->server) return make_client(device, std::move(*context));
  return (tcp ? make_tcp_server : make_rtu_server)(device, std::move(*context));
}

}  // namespace modbus
