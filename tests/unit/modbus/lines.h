// Other ends for the drivers under test: a libmodbus server in a thread, raw sockets, and two
// serial lines with a wire between them.
#pragma once

#include <gtest/gtest.h>
#include <modbus.h>

#include <atomic>
#include <functional>
#include <string>
#include <thread>

#include "vm/io/driver.h"
#include "vm/runtime/descriptor.h"

namespace modbus_test {

// A port of 127.0.0.1 that nobody listens on.
int free_port();
std::string local(int port);

ir::Device device(const std::string& driver, std::vector<ir::DeviceSetting> settings,
                  std::vector<ir::DeviceMapping> map);
ir::DeviceMapping in(ir::PointTable table, uint32_t first, uint32_t count, uint32_t value_bits,
                     uint32_t bit = 0);
ir::DeviceMapping out(ir::PointTable table, uint32_t first, uint32_t count, uint32_t value_bits,
                      uint32_t bit = 0);

// A driver with what it exchanges.
struct Rig {
  explicit Rig(const ir::Device& device);
  base::Status exchange();
  bool online() { return exchange().ok(); }
  // Exchanges until it holds, up to 5 s.
  bool until(const std::function<bool()>& holds);
  uint32_t input(size_t at, size_t bytes) const;

  std::unique_ptr<vm::IoDriver> driver;
  vm::DevicePoints points;
  base::Bytes outputs;
  base::Bytes inputs;
};

// A device: libmodbus' own server, one connection at a time.
class Peer {
 public:
  explicit Peer(int port);
  ~Peer();
  void cut() { cut_ = true; }             // closes the connection at the next request
  void delay(int ms) { delay_ms_ = ms; }  // before each answer

  modbus_mapping_t* const tables;
  std::atomic<int> connections{0};

 private:
  void serve();
  void connection(modbus_t* context);

  int port_;
  std::atomic<bool> ending_{false};
  std::atomic<bool> cut_{false};
  std::atomic<int> delay_ms_{0};
  vm::Descriptor listener_;
  std::thread thread_;
};

vm::Descriptor connect_raw(int port);
vm::Descriptor listen_raw(int port);
void send_raw(const vm::Descriptor& socket, const base::Bytes& bytes);
// A client of libmodbus; null when nobody answers.
struct FreeClient {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using ClientContext = std::unique_ptr<modbus_t, FreeClient>;
ClientContext connect_client(int port);

// Two serial lines, joined; each has a name that a driver can open.
class Wire {
 public:
  Wire();
  ~Wire();
  const std::string& left() const { return names_[0]; }
  const std::string& right() const { return names_[1]; }
  void cut(bool now) { cut_ = now; }
  void noise(int bytes) { noise_ = bytes; }  // once, to both sides

 private:
  void carry();
  std::string names_[2];
  vm::Descriptor ends_[2];
  vm::Descriptor slaves_[2];  // kept open, so that a line that is closed stays one
  std::atomic<bool> ending_{false};
  std::atomic<bool> cut_{false};
  std::atomic<int> noise_{0};
  std::thread thread_;
};

}  // namespace modbus_test
