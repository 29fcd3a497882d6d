#include "tools/stvm/device_drivers.h"

#include <cstdio>
#include <mutex>

#include "tools/stvm/event_log.h"
#include "tools/stvm/event_text.h"
#include "vm/io/exchange_port.h"
#include "vm/io/shared_memory_driver.h"
#include "vm/io/simulated_driver.h"
#ifdef STC_HAS_MODBUS
#include "adapters/modbus/modbus_drivers.h"
#endif

namespace stvm {

base::Result<std::unique_ptr<vm::IoDriver>> make_driver(const ir::Device& device) {
  const ir::DriverRow* row = ir::find_driver(device.driver);
  if (row == nullptr) {
    return base::Error{base::Refusal::kNoDriver,
                       "driver \"" + device.driver + "\" is unknown here"};
  }
  switch (row->id) {
    case ir::DriverId::kSimulated:
      return vm::make_simulated_driver(device);
    case ir::DriverId::kSharedMemory:
      return vm::make_shared_memory_driver(device);
    default:
      break;
  }
#ifdef STC_HAS_MODBUS
  return modbus::make_driver(device);
#else
  return base::Error{base::Refusal::kNoDriver,
                     "driver \"" + device.driver +
                         "\" is not part of this stvm: it was built without libmodbus (package "
                         "libmodbus-dev)"};
#endif
}

// One call for each line, so that those of two threads do not mix.
void log_device(vm::DeviceEvent event, const std::string& device, const std::string& text) {
  static std::mutex mutex;
  static EventLimits limits;
  const std::lock_guard lock(mutex);
  const int64_t now_ns = vm::ExchangePort::now_ns();
  for (const EventLimits::LeftOut& row : limits.take_left_out(now_ns)) {
    const std::string more = more_text(row.count, row.span_ns);
    std::fprintf(stderr, "%s: %s\n", row.source.c_str(), more.c_str());
  }
  const std::string source = "device " + device;
  if (!limits.pass(EventLog::event_of(event), source, now_ns)) return;
  std::fprintf(stderr, "%s: %s\n", source.c_str(), text.c_str());
}

base::Result<vm::DeviceIo::Options> device_options(const tools::Options& options,
                                                   vm::Clock* virtual_clock) {
  vm::DeviceIo::Options out{.make_driver = make_driver,
                            .virtual_clock = virtual_clock,
                            .log = log_device,
                            .confined = options.has("--seccomp")};
  for (const std::string& text : options.all("--device")) {
    base::Result<vm::DeviceOverride> row = vm::parse_device_override(text);
    if (!row.ok()) return row.error();
    out.overrides.push_back(std::move(*row));
  }
  return out;
}

}  // namespace stvm
