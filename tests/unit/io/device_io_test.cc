// B8, B9: several devices, each with its own exchange; loss, quality, and a scan that never waits.
#include "vm/io/device_io.h"

#include <map>

#include "tests/unit/io/rig.h"
#include "tests/unit/locks.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"
#include "vm/runtime/event_ring.h"

namespace vm {
namespace {

using io_test::device;
using io_test::eventually;
using io_test::FakeDevice;
using io_test::to_device;
using io_test::to_program;

constexpr const char* kEcho =
    "PROGRAM P VAR i AT %IB0 : BYTE; j AT %IB1 : BYTE; ok AT %IX8.0 : BOOL; q AT %QB0 : BYTE; "
    "r AT %QB1 : BYTE; n : DINT; END_VAR q := i; r := j; n := n + 1; END_PROGRAM";

constexpr const char* kFast =
    " CONFIGURATION C RESOURCE R ON PLC TASK T(INTERVAL := T#1ms, PRIORITY := 1); "
    "PROGRAM Main WITH T : P; END_RESOURCE END_CONFIGURATION";

DriverFactory fakes(std::map<std::string, FakeDevice*> devices) {
  return [devices](const ir::Device& wanted) -> base::Result<std::unique_ptr<IoDriver>> {
    const auto found = devices.find(wanted.name);
    if (found != devices.end()) return io_test::fake_driver(*found->second);
    return base::Error{base::Refusal::kNoDriver, "no fake of that name"};
  };
}

struct Receiver {
  explicit Receiver(DeviceIo& port) : io(port) {}
  uint8_t input(size_t byte) {
    io.receive(inputs);
    return inputs[byte];
  }
  DeviceIo& io;
  base::Bytes inputs = base::Bytes(16);
};

ir::Device with_quality(ir::Device made, const std::string& on_loss) {
  made.quality = {ir::DirectArea::kInput, 64, 1};
  made.settings.push_back({"on_loss", on_loss});
  return made;
}

TEST(DeviceIo, B9_EachDeviceHasItsOwnBuffers) {
  FakeDevice left;
  FakeDevice right;
  DeviceIo io({fakes({{"left", &left}, {"right", &right}})});
  auto image = io_test::build(kEcho, {device("left", {to_program(0, 1, 0), to_device(0, 1, 0)}),
                                      device("right", {to_program(5, 1, 1), to_device(7, 1, 1)})});
  ASSERT_TRUE(image);
  left.set(32, 11);
  right.set(37, 22);
  ASSERT_TRUE(io.prepare(*image).ok());
  io.use(image->digest());
  Receiver receiver(io);
  receiver.inputs.resize(image->image().input_bytes);
  EXPECT_TRUE(eventually([&] { return receiver.input(0) == 11 && receiver.input(1) == 22; }));
  io.send(base::Bytes{33, 44});
  EXPECT_TRUE(eventually([&] { return left.byte(0) == 33 && right.byte(7) == 44; }));
  EXPECT_EQ(right.byte(0), 0);
  left.broken = true;  // and the other goes on
  right.set(37, 23);
  EXPECT_TRUE(eventually([&] { return receiver.input(1) == 23; }));
  EXPECT_TRUE(eventually([&] { return io.status()[0].state == "lost"; }));
  EXPECT_EQ(io.status()[0].error, "the device is broken");
  EXPECT_EQ(io.status()[1].state, "online");
}

TEST(DeviceIo, LossHoldsOrClearsInputsAndTheQualityBitFalls) {
  FakeDevice holds;
  DeviceIo io({fakes({{"d", &holds}})});
  for (const char* policy : {"hold", "zero", "zero after 80 ms"}) {
    auto image = io_test::build(kEcho, {with_quality(device("d", {to_program(0, 1, 0)}), policy)});
    ASSERT_TRUE(image);
    holds.broken = false;
    holds.set(32, 7);
    ASSERT_TRUE(io.prepare(*image).ok());
    io.use(image->digest());
    io.settle();
    Receiver receiver(io);
    receiver.inputs.resize(image->image().input_bytes);
    ASSERT_TRUE(eventually([&] { return receiver.input(0) == 7 && receiver.input(8) == 1; }));
    holds.broken = true;
    ASSERT_TRUE(eventually([&] { return receiver.input(8) == 0; })) << policy;
    const bool zero = std::string(policy) == "zero";
    EXPECT_EQ(receiver.input(0), zero ? 0 : 7) << policy;
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
    EXPECT_EQ(receiver.input(0), std::string(policy) == "hold" ? 7 : 0) << policy;
    holds.broken = false;
    holds.set(32, 9);
    EXPECT_TRUE(eventually([&] { return receiver.input(0) == 9 && receiver.input(8) == 1; }));
  }
}

// Two tasks; the device traps the one whose scans go on behind it.
constexpr const char* kTwoTasks =
    " CONFIGURATION C RESOURCE R ON PLC TASK U(INTERVAL := T#10ms, PRIORITY := 1); "
    "{attribute 'on_trap' := 'go_on'} TASK T(INTERVAL := T#10ms, PRIORITY := 2); "
    "PROGRAM Main WITH T : P; PROGRAM Other WITH U : Q; END_RESOURCE END_CONFIGURATION "
    "PROGRAM Q VAR n : DINT; END_VAR n := n + 1; END_PROGRAM";

ir::Device trapping(const std::string& task) {
  return with_quality(device("d", {to_program(0, 1, 0)}, {{"period_ms", "10"}}), "trap " + task);
}

// On virtual time. Before the device was ever online there is no loss; each loss is one trap, the
// inputs stay, and the other task sees nothing of it.
TEST(DeviceIo, EachLossTrapsTheTaskOnce) {
  FakeDevice fake;
  VirtualClock clock;
  DeviceIo io({fakes({{"d", &fake}}), {}, &clock});
  auto image = io_test::build(std::string(kEcho) + kTwoTasks, {trapping("t")});
  ASSERT_TRUE(image);
  fake.broken = true;
  fake.set(32, 5);
  auto controller = Controller::start(*image, {}, clock, io);
  ASSERT_TRUE(controller.ok());
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) (*controller)->cycle();
  };
  const auto value = [&](const char* name) { return *(*controller)->get(name); };
  cycles(5);
  EXPECT_EQ((*controller)->trap_count(), 0u);
  EXPECT_EQ(value("Main.n"), "5");
  for (uint64_t loss = 1; loss <= 3; ++loss) {
    fake.broken = false;
    cycles(5);
    EXPECT_EQ((*controller)->trap_count(), loss - 1);
    EXPECT_EQ(value("Main.ok"), "TRUE");
    fake.broken = true;
    cycles(1);
    ASSERT_EQ((*controller)->trap_count(), loss);  // in the scan that would not see it
    EXPECT_EQ((*controller)->traps().back()->trap.kind, ir::TrapKind::kIoLost);
    EXPECT_EQ((*controller)->traps().back()->task, "T");
    cycles(4);
    EXPECT_EQ((*controller)->trap_count(), loss);
    EXPECT_EQ(value("Main.i"), "16#05");
    EXPECT_EQ(value("Main.ok"), "FALSE");
    EXPECT_EQ(value("Main.n"), std::to_string(5 + loss * 9));
    EXPECT_EQ(value("Other.n"), std::to_string(5 + loss * 10));
  }
}

// The task is the one of that name in the version that runs; a loss at the switch is none less.
TEST(DeviceIo, ALossIsOfTheTaskOfThatNameInTheRunningVersion) {
  FakeDevice fake;
  VirtualClock clock;
  DeviceIo io({fakes({{"d", &fake}}), {}, &clock});
  auto first = io_test::build(std::string(kEcho) + kFast, {trapping("T")});
  auto second = io_test::build(std::string(kEcho) + kTwoTasks, {trapping("T")});
  ASSERT_TRUE(first && second);
  const auto number = [](const ir::VerifiedImage& image) {
    uint32_t at = 0;
    while (image.image().tasks[at].name != "T") ++at;
    return at;
  };
  ASSERT_NE(number(*first), number(*second));
  ASSERT_TRUE(io.prepare(*first).ok());
  io.use(first->digest());
  base::Bytes inputs(first->image().input_bytes);
  const auto lost = [&] {
    clock.advance(10'000'000);
    io.send(base::Bytes(2));
    io.receive(inputs);
    base::Bytes tasks(2);
    io.lost_tasks(tasks);
    return tasks;
  };
  const auto only = [](uint32_t at) {
    base::Bytes tasks(2);
    tasks[at] = 1;
    return tasks;
  };
  EXPECT_EQ(lost(), base::Bytes(2));
  ASSERT_TRUE(io.prepare(*second).ok());
  ASSERT_EQ(second->image().input_bytes, inputs.size());
  io.use(second->digest());
  fake.broken = true;
  EXPECT_EQ(lost(), only(number(*second)));
  EXPECT_EQ(lost(), base::Bytes(2));
  io.use(first->digest());  // undo: lost as it was
  EXPECT_EQ(lost(), base::Bytes(2));
  fake.broken = false;
  EXPECT_EQ(lost(), base::Bytes(2));
  fake.broken = true;
  EXPECT_EQ(lost(), only(number(*first)));
}

TEST(DeviceIo, AnOverrideThatNamesNoTaskIsRefused) {
  FakeDevice fake;
  auto image = io_test::build(std::string(kEcho) + kFast, {device("d", {to_program(0, 1, 0)})});
  ASSERT_TRUE(image);
  DeviceIo io({fakes({{"d", &fake}}), {{"d", "on_loss", "trap Fast"}}});
  const base::Status refused = io.prepare(*image);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kUsage);
  EXPECT_EQ(refused.error().text,
            "--device d.on_loss: `on_loss` names `Fast`, which is no task that runs a program; "
            "there is `T`");
}

void release(FakeDevice& device) {
  device.hangs = false;
  device.hangs.notify_all();
}

TEST(DeviceIo, B8_ADriverThatHangsDelaysNoScan) {
  static FakeDevice hangs;  // its thread may outlive the test
  FakeDevice works;
  RealClock clock;
  DeviceIo io({fakes({{"hangs", &hangs}, {"works", &works}})});
  auto image = io_test::build(
      std::string(kEcho) + kFast,
      {with_quality(device("hangs", {to_program(0, 1, 0), to_device(0, 1, 0)}), "hold"),
       device("works", {to_program(0, 1, 1), to_device(0, 1, 1)})});
  ASSERT_TRUE(image);
  auto controller = Controller::start(*image, {}, clock, io);
  ASSERT_TRUE(controller.ok());
  hangs.set(32, 5);
  works.set(32, 6);
  const auto shows = [&](const char* path, const char* value) {
    return *(*controller)->get(path) == value;
  };
  while (!shows("Main.i", "16#05") || !shows("Main.j", "16#06")) (*controller)->cycle();
  hangs.hangs = true;
  // Whatever waited for it would not end: so each of these cycles has not, however late the machine
  // has begun it.
  const int64_t before = std::stoll(*(*controller)->get("Main.n"));
  int64_t cycles = 0;
  do {
    (*controller)->cycle();
    ++cycles;
  } while (cycles < 1000 || !shows("Main.ok", "FALSE"));
  EXPECT_GT(std::stoll(*(*controller)->get("Main.n")) - before, 900);
  EXPECT_EQ(*(*controller)->get("Main.i"), "16#05");
  EXPECT_EQ(*(*controller)->get("Main.j"), "16#06");
  RecordProperty("missed", static_cast<int>((*controller)->missed_releases()));
  release(hangs);
}

// nobody else sees it, since its thread does not come back to say so.
TEST(DeviceIo, R10_AnExchangeThatDoesNotEndIsToldAndSoIsItsEnd) {
  static FakeDevice hangs;  // its thread may outlive the test
  EventRing ring;
  DeviceIo io({.make_driver = fakes({{"d", &hangs}}), .events = &ring});
  auto image = io_test::build(kEcho, {device("d", {to_program(0, 1, 0), to_device(0, 1, 0)},
                                             {{"period_ms", "1"}, {"timeout_ms", "500"}})});
  ASSERT_TRUE(image);
  ASSERT_TRUE(io.prepare(*image).ok());
  io.use(image->digest());
  Receiver receiver(io);
  receiver.inputs.resize(image->image().input_bytes);
  hangs.set(32, 5);
  ASSERT_TRUE(eventually([&] { return receiver.input(0) == 5; }));
  std::vector<ScanEvent> events;
  const auto told = [&](ScanEventKind kind) {
    receiver.input(0);
    for (ScanEvent event; ring.take(event);) events.push_back(event);
    return !events.empty() && events.back().kind == kind;
  };
  hangs.hangs = true;
  ASSERT_TRUE(eventually([&] { return told(ScanEventKind::kDeviceLost); }));
  EXPECT_EQ(events.back().source.view(), "device d");
  EXPECT_TRUE(events.back().text.view().starts_with("its exchange does not end; its newest inputs"))
      << events.back().text.view();
  for (int i = 0; i < 100; ++i) EXPECT_TRUE(told(ScanEventKind::kDeviceLost)) << "once";
  const size_t lost = events.size();
  release(hangs);
  ASSERT_TRUE(eventually([&] { return told(ScanEventKind::kDeviceBack); }));
  EXPECT_EQ(events.size(), lost + 1);
  EXPECT_TRUE(events.back().text.view().starts_with("online after "));
  // An error is its thread's to tell, which knows the reason.
  hangs.broken = true;
  io.receive(receiver.inputs);
  ASSERT_TRUE(eventually([&] { return io.status()[0].errors > 0; }));
  EXPECT_FALSE(told(ScanEventKind::kDeviceLost));
}

// The same on virtual time, where a release is missed only by what the controller itself does.
TEST(DeviceIo, B8_NoReleaseIsMissedWhileADriverHangs) {
  static FakeDevice hangs;  // its thread may outlive the test
  VirtualClock clock;
  DeviceIo io({fakes({{"d", &hangs}})});
  auto image = io_test::build(
      std::string(kEcho) + kFast,
      {with_quality(device("d", {to_program(0, 1, 0), to_device(0, 1, 0)}), "hold")});
  ASSERT_TRUE(image);
  hangs.hangs = true;
  auto controller = Controller::start(*image, {}, clock, io);
  ASSERT_TRUE(controller.ok());
  const auto is_ok = [&] { return *(*controller)->get("Main.ok") != "FALSE"; };
  const uint64_t locks_before = tests::locks();
  while ((*controller)->cycles() < 20'000 || is_ok()) (*controller)->cycle();
  EXPECT_EQ((*controller)->missed_releases(), 0u);
  EXPECT_EQ(tests::locks(), locks_before);
  release(hangs);
}

TEST(DeviceIo, AnotherVersionKeepsTheConnectionAndUndoComesBack) {
  FakeDevice fake;
  DeviceIo io({fakes({{"d", &fake}})});
  auto first = io_test::build(kEcho, {device("d", {to_program(0, 1, 0), to_device(0, 2, 0)})});
  auto second = io_test::build(kEcho, {device("d", {to_program(1, 1, 1), to_device(0, 1, 0)})});
  ASSERT_TRUE(first && second);
  fake.set(32, 1);
  fake.set(33, 2);
  ASSERT_TRUE(io.prepare(*first).ok());
  io.use(first->digest());
  Receiver receiver(io);
  receiver.inputs.resize(9);
  ASSERT_TRUE(eventually([&] { return receiver.input(0) == 1; }));
  io.send(base::Bytes{33, 44});
  ASSERT_TRUE(eventually([&] { return fake.byte(1) == 44; }));

  ASSERT_TRUE(io.prepare(*second).ok());
  EXPECT_EQ(receiver.input(1), 0);
  EXPECT_EQ(fake.alive, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(30));  // it is read, and not written
  EXPECT_EQ(fake.byte(1), 44);
  io.use(second->digest());
  EXPECT_EQ(receiver.input(1), 2);                             // at once
  EXPECT_EQ(receiver.input(0), 0);                             // nobody provides it any more
  ASSERT_TRUE(eventually([&] { return fake.byte(1) == 0; }));  // an output that is gone
  EXPECT_EQ(fake.byte(0), 33);                                 // one that stays keeps its value
  io.send(base::Bytes{34, 45});
  ASSERT_TRUE(eventually([&] { return fake.byte(0) == 34; }));
  EXPECT_EQ(fake.byte(1), 0);

  io.use(first->digest());  // undo
  EXPECT_EQ(receiver.input(0), 1);
  io.send(base::Bytes{35, 46});
  EXPECT_TRUE(eventually([&] { return fake.byte(0) == 35 && fake.byte(1) == 46; }));
  io.settle();
  EXPECT_EQ(fake.alive, 1);
}

TEST(DeviceIo, ADeviceThatGoesGetsZerosAndIsClosedBehindAccept) {
  FakeDevice fake;
  DeviceIo io({fakes({{"d", &fake}})});
  auto first = io_test::build(kEcho, {device("d", {to_device(0, 2, 0)})});
  auto second = io_test::build(kEcho, {});
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(io.prepare(*first).ok());
  io.use(first->digest());
  io.send(base::Bytes{33, 44});
  ASSERT_TRUE(eventually([&] { return fake.byte(1) == 44; }));
  ASSERT_TRUE(io.prepare(*second).ok());
  io.use(second->digest());
  ASSERT_TRUE(eventually([&] { return fake.byte(0) == 0 && fake.byte(1) == 0; }));
  EXPECT_EQ(fake.alive, 1);  // undo needs it
  io.settle();
  EXPECT_EQ(fake.alive, 0);
  EXPECT_TRUE(io.status().empty());
}

TEST(DeviceIo, WhatCannotBeOpenedIsRefusedAndTheRestGoesOn) {
  FakeDevice fake;
  DeviceIo io({fakes({{"d", &fake}})});
  auto first = io_test::build(kEcho, {device("d", {to_program(0, 1, 0)})});
  auto second = io_test::build(
      kEcho, {device("d", {to_program(0, 1, 0)}), device("e", {to_program(0, 1, 1)})});
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(io.prepare(*first).ok());
  io.use(first->digest());
  const base::Status refused = io.prepare(*second);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kNoDriver);
  EXPECT_EQ(refused.error().text, "device `e`: no fake of that name");
  const int before = fake.exchanges;
  EXPECT_TRUE(eventually([&] { return fake.exchanges > before; }));
}

TEST(DeviceIo, TheLastOutputsGoOutWhenItEnds) {
  FakeDevice fake;
  auto image = io_test::build(
      kEcho, {device("d", {to_device(0, 1, 0)}, {{"period_ms", "3000"}, {"timeout_ms", "50"}})});
  ASSERT_TRUE(image);
  {
    DeviceIo io({fakes({{"d", &fake}})});
    ASSERT_TRUE(io.prepare(*image).ok());
    io.use(image->digest());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    io.send(base::Bytes{77, 0});
  }
  EXPECT_EQ(fake.byte(0), 77);
}

TEST(DeviceIo, AHangingDriverIsLeftBehindAtTheEnd) {
  static FakeDevice fake;  // its thread may outlive the test
  auto image = io_test::build(kEcho, {device("d", {to_program(0, 1, 0)})});
  ASSERT_TRUE(image);
  {
    DeviceIo io({fakes({{"d", &fake}})});
    fake.hangs = true;
    ASSERT_TRUE(io.prepare(*image).ok());
    io.use(image->digest());
    ASSERT_TRUE(eventually([&] { return fake.exchanges > 0; }));
  }
  EXPECT_EQ(fake.alive, 1) << "it hangs, and the end did not wait for it";
  release(fake);
  ASSERT_TRUE(eventually([&] { return fake.alive == 0; }));
}

}  // namespace
}  // namespace vm
