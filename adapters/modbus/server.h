// The server's side. An exchange shows the program's values, serves whoever asks for one period,
// and takes what was written; communication is lost when nobody has asked for timeout_ms. One
// thread serves all: a client that sends half a frame, nonsense or nothing, or does not read its
// answers, delays the others by some milliseconds and loses its connection.
#pragma once

#include "adapters/modbus/line.h"

namespace modbus {

// kDeviceFailed: out of memory.
base::Result<std::unique_ptr<vm::IoDriver>> make_tcp_server(const ir::Device& device,
                                                            Context context);
base::Result<std::unique_ptr<vm::IoDriver>> make_rtu_server(const ir::Device& device,
                                                            Context context);

}  // namespace modbus
