// Modbus clients against libmodbus' own server: values, limits, bad devices, reconnecting.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>

#include "adapters/modbus/line.h"
#include "tests/unit/modbus/lines.h"

namespace modbus_test {
namespace {

using ir::PointTable;

ir::Device client(int port, std::vector<ir::DeviceMapping> map,
                  std::vector<ir::DeviceSetting> more = {}) {
  std::vector<ir::DeviceSetting> settings{{"address", local(port)}, {"timeout_ms", "200"}};
  settings.insert(settings.end(), more.begin(), more.end());
  return device("modbus-tcp", std::move(settings), std::move(map));
}

TEST(Client, ReadsAndWritesEveryTable) {
  const int port = free_port();
  Peer peer(port);
  peer.tables->tab_input_bits[3] = 1;
  peer.tables->tab_bits[10] = 1;
  peer.tables->tab_input_registers[100] = 0x1234;
  peer.tables->tab_registers[5] = 0xfffe;
  Rig rig(
      client(port, {in(PointTable::kDiscrete, 0, 10, 1), in(PointTable::kCoil, 9, 2, 1, 16),
                    in(PointTable::kInput, 100, 1, 16, 32), in(PointTable::kHolding, 5, 1, 16, 48),
                    out(PointTable::kCoil, 20, 9, 1), out(PointTable::kHolding, 7, 2, 16, 16),
                    out(PointTable::kHolding, 17, 1, 16, 48)}));
  rig.outputs = {0x81, 0x01, 0xcd, 0xab, 0x02, 0x01, 0x34, 0x12};
  ASSERT_TRUE(rig.online());
  EXPECT_EQ(rig.input(0, 2), 8u);
  EXPECT_EQ(rig.input(2, 1), 2u);
  EXPECT_EQ(rig.input(3, 2), 0x1234u);
  EXPECT_EQ(rig.input(5, 2), 0xfffeu);
  EXPECT_EQ(peer.tables->tab_bits[20], 1);
  EXPECT_EQ(peer.tables->tab_bits[21], 0);
  EXPECT_EQ(peer.tables->tab_bits[27], 1);
  EXPECT_EQ(peer.tables->tab_bits[28], 1);
  EXPECT_EQ(peer.tables->tab_registers[7], 0xabcd);
  EXPECT_EQ(peer.tables->tab_registers[8], 0x0102);
  EXPECT_EQ(peer.tables->tab_registers[17], 0x1234);
  EXPECT_EQ(peer.connections, 1);
}

TEST(Client, LongRangesAreSeveralRequests) {
  const int port = free_port();
  Peer peer(port);
  for (int i = 0; i < 1000; ++i) peer.tables->tab_input_registers[i] = static_cast<uint16_t>(i * 7);
  for (int i = 0; i < 5000; ++i) peer.tables->tab_input_bits[i] = i % 3 == 0;
  Rig rig(client(
      port, {in(PointTable::kInput, 0, 1000, 16), in(PointTable::kDiscrete, 0, 5000, 1, 16000),
             out(PointTable::kHolding, 0, 300, 16), out(PointTable::kCoil, 0, 3000, 1, 4800)}));
  std::fill(rig.outputs.begin(), rig.outputs.end(), uint8_t{0xff});
  ASSERT_TRUE(rig.online());
  for (uint32_t i = 0; i < 1000; ++i) ASSERT_EQ(rig.input(2 * i, 2), i * 7);
  for (uint32_t i = 0; i < 5000; ++i) {
    ASSERT_EQ(rig.inputs[2000 + i / 8] >> (i % 8) & 1, i % 3 == 0 ? 1 : 0);
  }
  EXPECT_EQ(peer.tables->tab_registers[299], 0xffff);
  EXPECT_EQ(peer.tables->tab_registers[300], 0);
  EXPECT_EQ(peer.tables->tab_bits[2999], 1);
  EXPECT_EQ(peer.tables->tab_bits[3000], 0);
}

TEST(Client, OrderOfWordsIsASetting) {
  const int port = free_port();
  Peer peer(port);
  peer.tables->tab_registers[0] = 0x1122;
  peer.tables->tab_registers[1] = 0x3344;
  for (const char* order : {"high", "low"}) {
    Rig rig(client(port, {in(PointTable::kHolding, 0, 2, 32), out(PointTable::kHolding, 10, 4, 64)},
                   {{"word_order", order}}));
    rig.outputs = {1, 2, 3, 4, 5, 6, 7, 8};
    ASSERT_TRUE(rig.online());
    const bool high = std::string(order) == "high";
    EXPECT_EQ(rig.input(0, 4), high ? 0x11223344u : 0x33441122u);
    EXPECT_EQ(peer.tables->tab_registers[10], high ? 0x0807 : 0x0201);
    EXPECT_EQ(peer.tables->tab_registers[13], high ? 0x0201 : 0x0807);
  }
}

TEST(Client, WithoutOutputsNothingIsWritten) {
  const int port = free_port();
  Peer peer(port);
  peer.tables->tab_registers[1] = 5;
  Rig rig(client(port, {in(PointTable::kHolding, 1, 1, 16), out(PointTable::kHolding, 1, 1, 16)}));
  ASSERT_TRUE(rig.driver->exchange({rig.points, {}, rig.inputs, 0}).ok());
  EXPECT_EQ(rig.input(0, 2), 5u);
  EXPECT_EQ(peer.tables->tab_registers[1], 5);
}

TEST(Client, AnExceptionIsAnErrorAndKeepsTheConnection) {
  const int port = free_port();
  Peer peer(port);
  Rig rig(client(port, {in(PointTable::kInput, 19999, 2, 16)}));
  for (int i = 0; i < 3; ++i) {
    const base::Status done = rig.exchange();
    ASSERT_FALSE(done.ok());
    EXPECT_EQ(done.error().text, "input 19999..20000: Illegal data address");
  }
  EXPECT_EQ(peer.connections, 1);
}

TEST(Client, ACutConnectionIsMadeAgain) {
  const int port = free_port();
  auto peer = std::make_unique<Peer>(port);
  Rig rig(client(port, {in(PointTable::kInput, 0, 1, 16)}));
  ASSERT_TRUE(rig.online());
  peer->cut();
  EXPECT_FALSE(rig.online());
  ASSERT_TRUE(rig.until([&] { return peer->connections == 2 && rig.online(); }));
  peer.reset();  // and the device itself
  EXPECT_TRUE(rig.until([&] { return !rig.online(); }));
  const base::Status refused = rig.exchange();
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().text, "to connect: Connection refused");
  peer = std::make_unique<Peer>(port);
  peer->tables->tab_input_registers[0] = 77;
  EXPECT_TRUE(rig.until([&] { return rig.input(0, 2) == 77; }));
}

TEST(Client, ASlowDeviceFailsInTimeAndItsLateAnswerIsNotTaken) {
  const int port = free_port();
  Peer peer(port);
  Rig rig(client(port, {in(PointTable::kInput, 0, 1, 16), in(PointTable::kHolding, 0, 1, 16, 16)}));
  peer.tables->tab_input_registers[0] = 1;
  peer.tables->tab_registers[0] = 2;
  ASSERT_TRUE(rig.online());
  peer.delay(150);  // two requests take longer than the timeout of an exchange
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(rig.online());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(400));
  peer.delay(0);
  ASSERT_TRUE(rig.until([&] { return rig.online(); }));
  EXPECT_EQ(rig.input(0, 2), 1u);
  EXPECT_EQ(rig.input(2, 2), 2u);
}

// Whatever comes instead of an answer, in any portion: an error within the timeout, and no crash.
TEST(Client, GarbageAndDripsAreErrorsInTime) {
  const int port = free_port();
  vm::Descriptor listener = listen_raw(port);
  const base::Bytes answers[] = {
      {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff},
      {0, 1, 0, 0, 0, 5, 1, 4, 2, 0},           // a byte too few
      {0, 1, 0, 0, 0xff, 0xff, 1, 4, 2, 0, 1},  // a length that cannot be
      {0, 9, 0, 0, 0, 5, 1, 4, 2, 0, 1},        // another transaction's
      {0, 1, 0, 0, 0, 5, 1, 3, 2, 0, 1},        // another function's
      {0, 1, 0, 0, 0, 255, 1, 4, 250, 0, 1},    // too many registers
      base::Bytes(1000, 0x04),
      {},
  };
  Rig rig(client(port, {in(PointTable::kInput, 0, 1, 16)}));
  for (size_t i = 0; i < std::size(answers); ++i) {
    std::thread other([&] {
      vm::Descriptor socket(::accept(listener.get(), nullptr, nullptr));
      uint8_t request[64];
      (void)!::read(socket.get(), request, sizeof request);
      for (uint8_t byte : answers[i]) {
        if (::send(socket.get(), &byte, 1, MSG_NOSIGNAL) != 1) break;
        if (i == 0) std::this_thread::sleep_for(std::chrono::milliseconds(60));  // a drip
      }
      if (answers[i].empty()) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
    });
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_FALSE(rig.online()) << i;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(450)) << i;
    other.join();
  }
}

TEST(Client, Endpoints) {
  EXPECT_EQ(modbus::parse_endpoint("10.0.0.5:1502")->port, "1502");
  EXPECT_EQ(modbus::parse_endpoint("press.local")->port, "502");
  EXPECT_EQ(modbus::parse_endpoint("[fe80::1]:5020")->host, "fe80::1");
  for (const char* text : {"", ":502", "a:", "a:0", "a:65536", "a:5x", "[::1", "[::1]x", "a:-1"}) {
    EXPECT_FALSE(modbus::parse_endpoint(text).has_value()) << text;
  }
}

TEST(Client, RtuOverASerialLine) {
  Wire wire;
  Rig server(device("modbus-rtu-server",
                    {{"port", wire.right()}, {"unit", "7"}, {"period_ms", "20"}},
                    {in(PointTable::kHolding, 0, 2, 16), out(PointTable::kInput, 0, 2, 32)}));
  Rig rig(device("modbus-rtu", {{"port", wire.left()}, {"unit", "7"}, {"timeout_ms", "300"}},
                 {out(PointTable::kHolding, 0, 2, 16), in(PointTable::kInput, 0, 2, 32)}));
  server.outputs = {1, 2, 3, 4};
  rig.outputs = {5, 6, 7, 8};
  std::atomic<bool> ending{false};
  std::thread serving([&] {
    while (!ending) (void)server.exchange();
  });
  EXPECT_TRUE(rig.until([&] { return rig.inputs == base::Bytes{1, 2, 3, 4}; }));
  wire.cut(true);
  const base::Status lost = rig.exchange();
  EXPECT_FALSE(lost.ok());
  EXPECT_EQ(lost.error().text, "holding 0..1: Connection timed out");
  wire.cut(false);
  wire.noise(40);
  EXPECT_TRUE(rig.until([&] { return rig.online(); }));
  ending = true;
  serving.join();
  EXPECT_EQ(server.inputs, (base::Bytes{5, 6, 7, 8}));
}

}  // namespace
}  // namespace modbus_test
