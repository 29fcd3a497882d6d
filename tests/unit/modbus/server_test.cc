// Modbus servers against libmodbus' own clients, several at once, and what is no client at all.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>

#include "tests/unit/modbus/lines.h"

namespace {
std::atomic<uint64_t> accept_calls{0};
}
// In place of the C library's, for all of this program: counted.
extern "C" int accept4(int socket, sockaddr* peer, socklen_t* size, int flags) {
  ++accept_calls;
  return static_cast<int>(::syscall(SYS_accept4, socket, peer, size, flags));
}

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

// The answer to a request, without its header.
base::Bytes answer_to(const vm::Descriptor& socket, base::Bytes pdu) {
  base::Bytes frame{7, 9, 0, 0, 0, static_cast<uint8_t>(pdu.size() + 1), 1};
  frame.insert(frame.end(), pdu.begin(), pdu.end());
  send_raw(socket, frame);
  uint8_t got[260];
  const ssize_t size = ::recv(socket.get(), got, sizeof got, 0);
  if (size < 8) return {};
  EXPECT_EQ(got[0], 7);
  EXPECT_EQ(got[1], 9);
  EXPECT_EQ(got[4] * 256 + got[5], size - 6);
  EXPECT_EQ(got[6], 1);
  return base::Bytes(got + 7, got + size);
}

// V-01: functions that are not served are exception 01, counts, values and lengths that a function
// cannot have are 03; the connection stays.
TEST(Server, V01_WhatARequestSaysWrongIsAnExceptionAndTheConnectionStays) {
  const int port = free_port();
  Running server(port);
  ASSERT_TRUE(client(server, port)) << "it listens";
  const vm::Descriptor socket = connect_raw(port);
  struct {
    base::Bytes pdu;
    uint8_t exception;
  } const wrong[] = {
      {{0x63}, 1},                                // no such function
      {{8, 0, 0, 0, 0}, 1},                       // diagnostics: of serial lines
      {{7}, 1},                                   //
      {{43, 13, 0, 0}, 1},                        // another encapsulated interface
      {{4, 0, 0, 0, 0}, 3},                       // nothing
      {{4, 0, 0, 0, 126}, 3},                     // more registers than an answer holds
      {{1, 0, 100, 0x07, 0xd1}, 3},               // 2001 coils
      {{4, 0, 0}, 3},                             // shorter than its function needs
      {{4, 0, 0, 0, 1, 9, 9, 9}, 3},              // longer
      {{5, 0, 100, 1, 0}, 3},                     // neither on nor off
      {{16}, 3},                                  //
      {{16, 0, 0, 0, 123, 246, 1}, 3},            // fewer registers than it says
      {{16, 0, 0, 0, 1, 4, 1, 2, 3, 4}, 3},       // more bytes than registers
      {{15, 0, 100, 0, 9, 1, 1}, 3},              // nine coils in one byte
      {{22, 0, 0, 0, 0}, 3},                      //
      {{23, 0, 0, 0, 126, 0, 0, 0, 1, 2, 0, 0}, 3},
      {{4, 0, 200, 0, 1}, 2},                     // a good request for what is not mapped
  };
  for (const auto& row : wrong) {
    const base::Bytes expected{static_cast<uint8_t>(row.pdu[0] | 0x80), row.exception};
    EXPECT_EQ(answer_to(socket, row.pdu), expected) << int{row.pdu[0]};
  }
  EXPECT_EQ(answer_to(socket, {4, 0, 0, 0, 1}), (base::Bytes{4, 2, 0x12, 0x34}));
}

// V-01: 43/14 says who it is.
TEST(Server, V01_IdentificationHasOurName) {
  const int port = free_port();
  Running server(port);
  ASSERT_TRUE(client(server, port)) << "it listens";
  const vm::Descriptor socket = connect_raw(port);
  const base::Bytes all = answer_to(socket, {43, 14, 1, 0});
  ASSERT_GT(all.size(), 16u);
  EXPECT_EQ(base::Bytes(all.begin(), all.begin() + 7), (base::Bytes{43, 14, 1, 0x81, 0, 0, 3}));
  const std::string text(all.begin(), all.end());
  EXPECT_NE(text.find(std::string("\x00\x03stc\x01\x04stvm\x02", 12)), std::string::npos) << text;
  EXPECT_EQ(answer_to(socket, {43, 14, 4, 1}),
            (base::Bytes{43, 14, 4, 0x81, 0, 0, 1, 1, 4, 's', 't', 'v', 'm'}));
  EXPECT_EQ(answer_to(socket, {43, 14, 4, 9}), (base::Bytes{0xab, 2}));
  EXPECT_EQ(answer_to(socket, {43, 14, 5, 0}), (base::Bytes{0xab, 3}));
  EXPECT_EQ(answer_to(socket, {43, 14}), (base::Bytes{0xab, 3}));
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

// Without a descriptor for it, a client is served all the same, and a second one waits without
// being asked for again and again.
TEST(Server, DescriptorsThatRunOutAreNoBusyLoop) {
  const int port = free_port();
  Rig rig(device("modbus-tcp-server", {{"address", local(port)}, {"period_ms", "5"}},
                 {out(PointTable::kHolding, 0, 4, 16)}));
  ASSERT_TRUE(rig.online()) << "idle is no error where others only read";
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
  rlimit low = before;
  low.rlim_cur = 64;
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &low), 0);
  const vm::Descriptor first = connect_raw(port);
  const vm::Descriptor second = connect_raw(port);
  std::vector<vm::Descriptor> all;  // whatever is free below the limit
  for (;;) {
    vm::Descriptor next(::dup(first.get()));
    if (!next.valid()) break;
    all.push_back(std::move(next));
  }
  const auto begin = std::chrono::steady_clock::now();
  const uint64_t accepts = accept_calls;
  for (int i = 0; i < 60; ++i) (void)rig.exchange().ok();
  const auto elapsed = std::chrono::steady_clock::now() - begin;
  const auto tries = static_cast<uint64_t>(elapsed / std::chrono::milliseconds(100));
  EXPECT_LE(accept_calls - accepts, 4 + tries);
  EXPECT_GE(accept_calls - accepts, 3u) << "one was served, and the other one is tried";
  const base::Bytes read = {0, 1, 0, 0, 0, 6, 1, 3, 0, 0, 0, 1};
  uint8_t answer[16];
  send_raw(first, read);
  send_raw(second, read);
  ASSERT_TRUE(rig.until([&] { return ::recv(first.get(), answer, 16, MSG_DONTWAIT) == 11; }));
  all.clear();
  ASSERT_TRUE(rig.until([&] { return ::recv(second.get(), answer, 16, MSG_DONTWAIT) == 11; }));
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
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
