// The server's side. An exchange shows the program's values, serves whoever asks for one period,
// and takes what was written; where it has inputs, communication is lost when nobody has asked for
// timeout_ms. What a request says wrong is answered with an exception, by TCP never with the end of
// the connection. One
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
