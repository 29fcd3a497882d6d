// Modbus servers against libmodbus' own clients, several at once, and what is no client at all.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <cerrno>
#include <chrono>

#include "tests/unit/modbus/lines.h"

namespace modbus_test {
namespace {

using ir::PointTable;

// A server that runs in a thread of its own.
class Running {
 public:
  explicit Running(int port, const std::string& clients = "8")
      : rig_(device("modbus-tcp-server",
                    {{"address", local(port)},
                     {"clients", clients},
                     {"period_ms", "5"},
                     {"timeout_ms", "100"}},
                    {in(PointTable::kHolding, 0, 4, 16), in(PointTable::kCoil, 100, 8, 1, 64),
                     out(PointTable::kInput, 0, 2, 16), out(PointTable::kDiscrete, 8, 8, 1, 32),
                     out(PointTable::kHolding, 10, 2, 32, 64)})),
        seen_(rig_.inputs.size()) {
    rig_.outputs = {0x34, 0x12, 0x78, 0x56, 0x81, 0xdd, 0xcc, 0xbb, 0xaa};
    thread_ = std::thread([this] {
      while (!ending_) {
        online_ = rig_.online();
        for (size_t i = 0; i < seen_.size(); ++i) seen_[i] = rig_.inputs[i];
      }
    });
  }
  ~Running() {
    ending_ = true;
    thread_.join();
  }
  bool eventually(const std::function<bool()>& holds) {
    for (int i = 0; i < 1000; ++i) {
      if (holds()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
  }
  bool online() const { return online_; }
  uint8_t input(size_t at) const { return seen_[at]; }

 private:
  Rig rig_;
  std::vector<std::atomic<uint8_t>> seen_;  // the inputs of the last exchange
  std::atomic<bool> ending_{false};
  std::atomic<bool> online_{false};
  std::thread thread_;
};

ClientContext client(Running& server, int port) {
  ClientContext context;
  server.eventually([&] { return (context = connect_client(port)) != nullptr; });
  return context;
}

uint16_t input_register(modbus_t* context, int at) {
  uint16_t value = 0;
  return modbus_read_input_registers(context, at, 1, &value) == 1 ? value : 0;
}

TEST(Server, ShowsOutputsAndTakesInputs) {
  const int port = free_port();
  Running server(port);
  ClientContext context = client(server, port);
  ASSERT_TRUE(context);
  EXPECT_TRUE(server.eventually([&] { return input_register(context.get(), 1) == 0x5678; }));
  uint16_t words[4] = {1, 2, 3, 0xabcd};
  EXPECT_EQ(modbus_write_registers(context.get(), 0, 4, words), 4);
  EXPECT_EQ(modbus_write_bit(context.get(), 107, 1), 1);
  EXPECT_TRUE(server.eventually([&] {
    return server.input(6) == 0xcd && server.input(7) == 0xab && server.input(8) == 0x80;
  }));
  uint8_t bits[8];
  EXPECT_EQ(modbus_read_input_bits(context.get(), 8, 8, bits), 8);
  EXPECT_EQ(bits[0], 1);
  EXPECT_EQ(bits[7], 1);
  EXPECT_EQ(modbus_read_registers(context.get(), 10, 2, words), 2);
  EXPECT_EQ(words[0], 0xaabb);  // high word first
  EXPECT_EQ(words[1], 0xccdd);
  EXPECT_EQ(modbus_read_registers(context.get(), 0, 4, words), 4);  // what was written
  EXPECT_EQ(words[3], 0xabcd);
  EXPECT_TRUE(server.online());
  context.reset();
  EXPECT_TRUE(server.eventually([&] { return !server.online(); }));  // nobody asks any more
}

TEST(Server, WhatIsNotMappedIsException02) {
  const int port = free_port();
  Running server(port);
  ClientContext context = client(server, port);
  ASSERT_TRUE(context);
  uint16_t words[8] = {};
  uint8_t bits[16] = {};
  auto refused = [](int result) { return result == -1 && errno == EMBXILADD; };
  EXPECT_TRUE(refused(modbus_read_registers(context.get(), 4, 1, words)));
  EXPECT_TRUE(refused(modbus_read_registers(context.get(), 3, 2, words)));  // runs out of it
  EXPECT_TRUE(refused(modbus_read_registers(context.get(), 65535, 1, words)));
  EXPECT_TRUE(refused(modbus_write_register(context.get(), 10, 1)));  // the program's to write
  EXPECT_TRUE(refused(modbus_write_registers(context.get(), 3, 2, words)));
  EXPECT_TRUE(refused(modbus_mask_write_register(context.get(), 10, 0, 1)));
  EXPECT_TRUE(refused(modbus_write_and_read_registers(context.get(), 10, 1, words, 0, 1, words)));
  EXPECT_TRUE(refused(modbus_write_and_read_registers(context.get(), 0, 1, words, 5, 1, words)));
  EXPECT_TRUE(refused(modbus_read_bits(context.get(), 0, 16, bits)));
  EXPECT_TRUE(refused(modbus_read_input_bits(context.get(), 7, 2, bits)));
  EXPECT_TRUE(refused(modbus_write_bits(context.get(), 101, 8, bits)));
  EXPECT_EQ(modbus_read_registers(context.get(), 0, 4, words), 4);  // the connection is as it was
}

TEST(Server, SeveralClientsAtOnceAndTheMostSilentMakesRoom) {
  const int port = free_port();
  Running server(port, "3");
  std::vector<ClientContext> clients;
  for (int i = 0; i < 3; ++i) clients.push_back(client(server, port));
  for (const ClientContext& context : clients) {
    ASSERT_TRUE(context);
    EXPECT_TRUE(server.eventually([&] { return input_register(context.get(), 0) == 0x1234; }));
  }
  EXPECT_EQ(input_register(clients[0].get(), 0), 0x1234);  // the second is the most silent now
  ClientContext fourth = client(server, port);
  ASSERT_TRUE(fourth);
  EXPECT_EQ(input_register(fourth.get(), 0), 0x1234);
  EXPECT_EQ(input_register(clients[0].get(), 0), 0x1234);
  EXPECT_EQ(input_register(clients[1].get(), 0), 0);
  EXPECT_EQ(input_register(clients[2].get(), 0), 0x1234);
}

bool closed_within(const vm::Descriptor& socket, int ms) {
  pollfd waiting{socket.get(), POLLIN, 0};
  uint8_t byte[300];
  while (::poll(&waiting, 1, ms) > 0) {
    if (::recv(socket.get(), byte, sizeof byte, 0) <= 0) return true;
  }
  return false;
}

TEST(Server, HalfFramesAndGarbageHurtOnlyWhoeverSendsThem) {
  const int port = free_port();
  Running server(port);
  ClientContext good = client(server, port);
  ASSERT_TRUE(good);
  ASSERT_TRUE(server.eventually([&] { return input_register(good.get(), 0) == 0x1234; }));
  vm::Descriptor half = connect_raw(port);
  send_raw(half, {0, 1, 0, 0, 0, 6, 1, 4});
  const base::Bytes frames[] = {
      {0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff},
      {0, 1, 0, 0, 0, 0, 1, 4, 0, 0, 0, 1},             // no length
      {0, 1, 0, 0, 0xff, 0, 1, 4, 0, 0, 0, 1},          // too long
      {0, 1, 0, 0, 0, 2, 1, 16},                        // shorter than its function needs
      {0, 1, 0, 0, 0, 8, 1, 16, 0, 0, 0, 123, 246, 1},  // fewer registers than it says
      {0, 1, 0, 0, 0, 20, 1, 4, 0, 0, 0, 1, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9, 9},
      {0, 1, 0, 0, 0, 2, 1, 0x63},  // no such function
  };
  for (const base::Bytes& frame : frames) {
    vm::Descriptor bad = connect_raw(port);
    send_raw(bad, frame);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_EQ(input_register(good.get(), 0), 0x1234);
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::milliseconds(500));
  }
  EXPECT_TRUE(closed_within(half, 3000));  // nobody waits for its other half for long
  vm::Descriptor gone = connect_raw(port);
  gone = vm::Descriptor();
  EXPECT_EQ(input_register(good.get(), 0), 0x1234);
}

// It asks and asks, and reads no answer: its connection goes, the others stay.
TEST(Server, AClientThatReadsNothingIsDropped) {
  const int port = free_port();
  Running server(port);
  ClientContext good = client(server, port);
  ASSERT_TRUE(good);
  vm::Descriptor deaf = connect_raw(port);
  const base::Bytes request{0, 1, 0, 0, 0, 6, 1, 4, 0, 0, 0, 2};
  int sent = 0;
  while (sent < 2'000'000 &&
         ::send(deaf.get(), request.data(), request.size(), MSG_NOSIGNAL | MSG_DONTWAIT) > 0) {
    ++sent;
  }
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(server.eventually([&] { return input_register(good.get(), 0) == 0x1234; }));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
}

struct Events : vm::OutsideEvents {
  void written(const std::string& who, const std::string& what) override {
    note(who, "wrote " + what);
  }
  void refused(const std::string& who, const std::string& what) override {
    note(who, "may not write " + what);
  }
  void note(const std::string& who, const std::string& what) {
    EXPECT_TRUE(who.starts_with("127.0.0.1:")) << who;
    lines.push_back(what);
  }
  std::vector<std::string> lines;
};

// `<->`: others see the program's value and can write it; the write goes on to the control thread.
TEST(Server, WritesToTheProgramsPointsArePassedOnWhole) {
  const int port = free_port();
  ir::DeviceMapping words = out(PointTable::kHolding, 0, 4, 32);
  ir::DeviceMapping coils = out(PointTable::kCoil, 0, 8, 1, 64);
  words.writable = coils.writable = true;
  Rig rig(device("modbus-tcp-server", {{"address", local(port)}, {"period_ms", "5"}},
                 {words, coils, out(PointTable::kHolding, 4, 1, 16, 128)}));
  vm::WriteQueue queue(6);
  Events events;
  std::vector<vm::OutsideWrite> taken;
  std::atomic<bool> taking{true};
  std::atomic<size_t> count{0};
  std::atomic<bool> ending{false};
  std::thread serving([&] {
    while (!ending) {
      (void)rig.driver->exchange({rig.points, rig.outputs, rig.inputs, 0, &queue, &events});
      if (taking) queue.take([&](const vm::OutsideWrite& write) { taken.push_back(write); });
      count = taken.size();
    }
  });
  ClientContext context;
  for (int i = 0; i < 500 && !context; ++i) {
    context = connect_client(port);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ASSERT_TRUE(context);
  const uint16_t values[2] = {0x1111, 0x2222};
  EXPECT_EQ(modbus_write_registers(context.get(), 2, 2, values), 2);
  EXPECT_EQ(modbus_write_bit(context.get(), 5, 1), 1);
  EXPECT_EQ(modbus_write_register(context.get(), 4, 1), -1);  // `<-` only
  EXPECT_EQ(errno, EMBXILADD);
  const uint8_t request[] = {1, 16, 0, 0, 0, 0, 0};  // none at all is libmodbus' to refuse
  EXPECT_GT(modbus_send_raw_request(context.get(), request, sizeof request), 0);
  uint8_t answer[MODBUS_TCP_MAX_ADU_LENGTH];
  EXPECT_EQ(modbus_receive_confirmation(context.get(), answer), 9);
  for (int i = 0; i < 1000 && count < 3; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  taking = false;
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  const uint16_t many[4] = {1, 2, 3, 4};
  EXPECT_EQ(modbus_write_registers(context.get(), 0, 4, many), 4);
  EXPECT_EQ(modbus_write_registers(context.get(), 0, 4, many), -1);  // no room until a boundary
  EXPECT_EQ(errno, EMBXSBUSY);
  ending = true;
  serving.join();
  ASSERT_EQ(taken.size(), 3u);
  EXPECT_EQ(taken[0].bit, 32u + 16u);  // the high word comes first
  EXPECT_EQ(taken[0].value, 0x1111);
  EXPECT_EQ(taken[1].bit, 32u);
  EXPECT_EQ(taken[1].value, 0x2222);
  EXPECT_EQ(taken[2].bit, 64u + 5u);
  EXPECT_EQ(taken[2].bits, 1u);
  EXPECT_EQ(taken[2].value, 1);
  EXPECT_EQ(events.lines, (std::vector<std::string>{"wrote holding 2..3", "wrote coil 5",
                                                    "may not write holding 4",
                                                    "wrote holding 0..3"}));
}

TEST(Server, TheDefaultAddressIsThisMachine) {
  EXPECT_EQ(ir::setting(device("modbus-tcp-server", {}, {}), "address"), "127.0.0.1:502");
}

// Nobody asks: that is a loss of communication, and no error.
TEST(Server, AServerThatNobodyAsksIsIdle) {
  const int port = free_port();
  vm::Descriptor taken = listen_raw(port);
  Rig rig(device("modbus-tcp-server",
                 {{"address", local(port)}, {"period_ms", "1"}, {"timeout_ms", "1"}},
                 {in(PointTable::kHolding, 0, 1, 16)}));
  EXPECT_FALSE(rig.online());
  EXPECT_FALSE(rig.driver->idle());
  taken = vm::Descriptor();
  EXPECT_TRUE(rig.until([&] { return rig.driver->idle(); }));
}

TEST(Server, APortThatIsTakenIsAnErrorUntilItIsFree) {
  const int port = free_port();
  vm::Descriptor taken = listen_raw(port);
  Rig rig(device("modbus-tcp-server", {{"address", local(port)}, {"period_ms", "5"}},
                 {in(PointTable::kHolding, 0, 1, 16)}));
  const base::Status done = rig.exchange();
  ASSERT_FALSE(done.ok());
  EXPECT_NE(done.error().text.find("Address already in use; another process listens there"),
            std::string::npos);
  taken = vm::Descriptor();
  (void)rig.exchange();
  EXPECT_TRUE(connect_client(port));
}

}  // namespace
}  // namespace modbus_test
