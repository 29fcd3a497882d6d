#include "tests/unit/modbus/lines.h"

#include <arpa/inet.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>

#include <algorithm>
#include <chrono>

#include "adapters/modbus/modbus_drivers.h"

namespace modbus_test {
namespace {

sockaddr_in address_of(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<uint16_t>(port));
  return address;
}

ir::DeviceMapping mapping(ir::PointTable table, uint32_t first, uint32_t count, bool to_device,
                          uint32_t value_bits, uint32_t bit) {
  const auto area = to_device ? ir::DirectArea::kOutput : ir::DirectArea::kInput;
  return {table, first, count, to_device, {area, bit, value_bits}};
}

}  // namespace

int free_port() {
  vm::Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  sockaddr_in address = address_of(0);
  socklen_t size = sizeof address;
  ::bind(socket.get(), reinterpret_cast<sockaddr*>(&address), size);
  ::getsockname(socket.get(), reinterpret_cast<sockaddr*>(&address), &size);
  return ntohs(address.sin_port);
}

std::string local(int port) { return "127.0.0.1:" + std::to_string(port); }

ir::Device device(const std::string& driver, std::vector<ir::DeviceSetting> settings,
                  std::vector<ir::DeviceMapping> map) {
  ir::Device made{"d", driver, std::move(settings), std::move(map), {}};
  const auto fault = ir::find_fault({made}, nullptr);
  EXPECT_FALSE(fault.has_value()) << fault->text;
  return made;
}

ir::DeviceMapping in(ir::PointTable table, uint32_t first, uint32_t count, uint32_t value_bits,
                     uint32_t bit) {
  return mapping(table, first, count, false, value_bits, bit);
}
ir::DeviceMapping out(ir::PointTable table, uint32_t first, uint32_t count, uint32_t value_bits,
                      uint32_t bit) {
  return mapping(table, first, count, true, value_bits, bit);
}

Rig::Rig(const ir::Device& device) : points(vm::points_of(device)) {
  auto made = modbus::make_driver(device);
  EXPECT_TRUE(made.ok());
  if (made.ok()) driver = std::move(*made);
  outputs.resize(points.output_bytes);
  inputs.resize(points.input_bytes);
}

base::Status Rig::exchange() { return driver->exchange({points, outputs, inputs, 0}); }

bool Rig::until(const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  while (std::chrono::steady_clock::now() < end) {
    (void)exchange();
    if (holds()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return false;
}

uint32_t Rig::input(size_t at, size_t bytes) const {
  uint32_t value = 0;
  for (size_t i = bytes; i-- != 0;) value = value << 8 | inputs[at + i];
  return value;
}

Peer::Peer(int port)
    : tables(modbus_mapping_new(20000, 20000, 20000, 20000)),
      port_(port),
      listener_(listen_raw(port)),
      thread_([this] { serve(); }) {}

Peer::~Peer() {
  ending_ = true;
  thread_.join();
  modbus_mapping_free(tables);
}

void Peer::serve() {
  ClientContext context(modbus_new_tcp_pi("127.0.0.1", std::to_string(port_).c_str()));
  while (!ending_) {
    pollfd waiting{listener_.get(), POLLIN, 0};
    if (::poll(&waiting, 1, 5) <= 0) continue;
    const int accepted = ::accept(listener_.get(), nullptr, nullptr);
    if (accepted < 0) continue;
    ++connections;
    modbus_set_socket(context.get(), accepted);
    connection(context.get());
    modbus_close(context.get());
  }
}

void Peer::connection(modbus_t* context) {
  uint8_t request[MODBUS_TCP_MAX_ADU_LENGTH];
  while (!ending_) {
    pollfd waiting{modbus_get_socket(context), POLLIN, 0};
    if (::poll(&waiting, 1, 5) <= 0) continue;
    const int length = modbus_receive(context, request);
    if (length < 0 || cut_.exchange(false)) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms_));
    if (modbus_reply(context, request, length, tables) < 0) return;
  }
}

vm::Descriptor connect_raw(int port) {
  vm::Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  const sockaddr_in address = address_of(port);
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    return {};
  }
  return socket;
}

vm::Descriptor listen_raw(int port) {
  vm::Descriptor socket(::socket(AF_INET, SOCK_STREAM, 0));
  const int on = 1;
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  const sockaddr_in address = address_of(port);
  EXPECT_EQ(::bind(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  EXPECT_EQ(::listen(socket.get(), 8), 0);
  return socket;
}

void send_raw(const vm::Descriptor& socket, const base::Bytes& bytes) {
  EXPECT_EQ(::send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(bytes.size()));
}

ClientContext connect_client(int port) {
  ClientContext context(modbus_new_tcp_pi("127.0.0.1", std::to_string(port).c_str()));
  modbus_set_response_timeout(context.get(), 2, 0);
  return modbus_connect(context.get()) == 0 ? std::move(context) : nullptr;
}

Wire::Wire() {
  for (int side = 0; side < 2; ++side) {
    int master = -1;
    int slave = -1;
    char name[128];
    termios raw{};
    ::cfmakeraw(&raw);
    EXPECT_EQ(::openpty(&master, &slave, name, &raw, nullptr), 0);
    names_[side] = name;
    ends_[side] = vm::Descriptor(master);
    slaves_[side] = vm::Descriptor(slave);
  }
  thread_ = std::thread([this] { carry(); });
}

Wire::~Wire() {
  ending_ = true;
  thread_.join();
}

void Wire::carry() {
  while (!ending_) {
    if (const int bytes = noise_.exchange(0); bytes != 0) {
      const base::Bytes garbage(static_cast<size_t>(bytes), 0x5a);
      for (const vm::Descriptor& end : ends_) {
        EXPECT_EQ(::write(end.get(), garbage.data(), garbage.size()), bytes);
      }
    }
    pollfd both[2] = {{ends_[0].get(), POLLIN, 0}, {ends_[1].get(), POLLIN, 0}};
    if (::poll(both, 2, 5) <= 0) continue;
    for (int side = 0; side < 2; ++side) {
      if ((both[side].revents & POLLIN) == 0) continue;
      uint8_t bytes[512];
      const ssize_t got = ::read(ends_[side].get(), bytes, sizeof bytes);
      if (got <= 0 || cut_) continue;
      EXPECT_EQ(::write(ends_[1 - side].get(), bytes, static_cast<size_t>(got)), got);
    }
  }
}

}  // namespace modbus_test
