// What others write to %Q and %M through a server: it reaches the variables at a boundary, whole,
// and the program's own writes come after it.
#include "tests/unit/io/rig.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace vm {
namespace {

constexpr const char* kProgram =
    "VAR_GLOBAL word AT %MW2 : INT := 5; long AT %MD2 : DINT := 70000; flag AT %MX12.3 : BOOL; "
    "text AT %MB40 : STRING[3] := 'abc'; lamp AT %QX0.1 : BOOL; level AT %QW1 : INT; END_VAR "
    "PROGRAM P VAR n : DINT; own AT %QW2 : INT; END_VAR n := n + 1; own := 9; END_PROGRAM";

constexpr const char* kTwoTasks =
    " PROGRAM Other VAR m : DINT; mine AT %QW3 : INT; END_VAR m := m + 1; mine := 3; END_PROGRAM "
    "CONFIGURATION C RESOURCE R ON PLC TASK A(INTERVAL := T#10ms, PRIORITY := 1); "
    "TASK B(INTERVAL := T#20ms, PRIORITY := 2); PROGRAM P WITH A : P; "
    "PROGRAM O WITH B : Other; END_RESOURCE END_CONFIGURATION";

// Puts what the test wants at the next exchange, and keeps what it was given.
struct Outside {
  std::mutex mutex;
  std::vector<OutsideWrite> writes;
  base::Bytes outputs;
  uint16_t word(size_t at) {
    std::lock_guard lock(mutex);
    return at + 1 < outputs.size() ? static_cast<uint16_t>(outputs[at] | outputs[at + 1] << 8) : 0;
  }
  void write(std::vector<OutsideWrite> wanted) {
    std::lock_guard lock(mutex);
    writes = std::move(wanted);
  }
};

class OutsideDriver : public IoDriver {
 public:
  explicit OutsideDriver(Outside& outside) : outside_(outside) {}
  base::Status exchange(const Exchange& exchange) override {
    std::lock_guard lock(outside_.mutex);
    outside_.outputs.assign(exchange.outputs.begin(), exchange.outputs.end());
    for (const OutsideWrite& write : outside_.writes) exchange.writes->put(write);
    if (exchange.writes != nullptr) exchange.writes->publish();
    outside_.writes.clear();
    return base::Ok{};
  }

 private:
  Outside& outside_;
};

ir::Device server(std::vector<ir::DeviceMapping> map) {
  return {"hmi", "modbus-tcp-server", {{"period_ms", "1"}}, std::move(map), {}};
}

struct Plant {
  explicit Plant(const std::vector<ir::Device>& devices, const std::string& more = "")
      : io({[this](const ir::Device&) -> base::Result<std::unique_ptr<IoDriver>> {
          return std::unique_ptr<IoDriver>(std::make_unique<OutsideDriver>(outside));
        }}) {
    auto image = io_test::build(kProgram + more, devices);
    if (!image) return;
    auto started = Controller::start(*image, {}, clock, io);
    EXPECT_TRUE(started.ok());
    if (started.ok()) controller = std::move(*started);
  }
  std::string get(const std::string& path) { return *controller->get(path); }
  // Cycles until it holds.
  bool until(const std::function<bool()>& holds) {
    return io_test::eventually([&] {
      controller->cycle();
      return holds();
    });
  }

  Outside outside;
  VirtualClock clock;
  DeviceIo io;
  std::unique_ptr<Controller> controller;
};

TEST(Window, MarkersAreShownAndWritten) {
  const ir::DeviceMapping markers{ir::PointTable::kHolding,         0,   10, true,
                                  {ir::DirectArea::kMarker, 0, 16}, true};
  Plant plant({server({markers})});
  ASSERT_TRUE(plant.controller);
  ASSERT_TRUE(plant.until([&] { return plant.outside.word(4) == 5; }));  // %MW2
  EXPECT_EQ(plant.outside.word(8), 70000 & 0xffff);                      // %MD2
  EXPECT_EQ(plant.outside.word(10), 70000 >> 16);
  plant.outside.write({{ir::DirectArea::kMarker, 32, 16, 0xfff9},
                       {ir::DirectArea::kMarker, 64, 16, 0xd431},
                       {ir::DirectArea::kMarker, 80, 16, 0xfffe},
                       {ir::DirectArea::kMarker, 96 + 3, 1, 1}});
  ASSERT_TRUE(plant.until([&] { return plant.get("word") == "-7"; }));
  EXPECT_EQ(plant.get("long"), "-76751");  // both halves at one boundary
  EXPECT_EQ(plant.get("flag"), "TRUE");
  EXPECT_EQ(plant.get("text"), "'abc'");
  EXPECT_TRUE(plant.until([&] { return plant.outside.word(4) == 0xfff9; }));
}

TEST(Window, OutputsKeepWhatOthersWriteUntilTheProgramWrites) {
  const ir::DeviceMapping outputs{ir::PointTable::kHolding,         0,   3, true,
                                  {ir::DirectArea::kOutput, 0, 16}, true};
  Plant plant({server({outputs})});
  ASSERT_TRUE(plant.controller);
  ASSERT_TRUE(plant.until([&] { return plant.outside.word(4) == 9; }));
  plant.outside.write({{ir::DirectArea::kOutput, 1, 1, 1},
                       {ir::DirectArea::kOutput, 16, 16, 1234},
                       {ir::DirectArea::kOutput, 32, 16, 1}});
  ASSERT_TRUE(plant.until([&] { return plant.get("level") == "1234"; }));
  EXPECT_EQ(plant.get("lamp"), "TRUE");
  EXPECT_TRUE(plant.until([&] { return plant.outside.word(2) == 1234; }));
  EXPECT_EQ(plant.outside.word(0), 2);
  EXPECT_TRUE(plant.until([&] { return plant.get("P.own") == "9"; }));  // the program's last word
}

// An output that no task writes is still sent when others write it.
TEST(Window, OutputsOfNoTaskAreSentToo) {
  const ir::DeviceMapping outputs{ir::PointTable::kHolding,         0,   4, true,
                                  {ir::DirectArea::kOutput, 0, 16}, true};
  Plant plant({server({outputs})}, kTwoTasks);
  ASSERT_TRUE(plant.controller);
  ASSERT_TRUE(plant.until([&] { return plant.outside.word(6) == 3; }));
  plant.outside.write({{ir::DirectArea::kOutput, 16, 16, 1234}});
  EXPECT_TRUE(plant.until([&] { return plant.outside.word(2) == 1234; }));
  EXPECT_EQ(plant.outside.word(4), 9);
}

TEST(Window, TheQueueIsBoundedAndTakenTogether) {
  WriteQueue queue(4);
  EXPECT_EQ(queue.room(), 4u);
  for (uint16_t i = 0; i < 4; ++i) queue.put({ir::DirectArea::kOutput, i, 1, i});
  EXPECT_EQ(queue.room(), 0u);
  int seen = 0;
  EXPECT_FALSE(queue.take([&](const auto&) { ++seen; }));  // not published
  queue.publish();
  EXPECT_TRUE(queue.take([&](const OutsideWrite& write) { EXPECT_EQ(write.value, seen++); }));
  EXPECT_EQ(queue.room(), 4u);
  EXPECT_FALSE(queue.take([&](const auto&) { ++seen; }));
}

TEST(Window, MeaninglessOnesAreRefused) {
  auto fault = [](ir::PointTable table, ir::DirectArea area, bool to_device, const char* driver) {
    ir::Device made = server(
        {{table, 0, 1, to_device, {area, 0, table == ir::PointTable::kHolding ? 16u : 1u}, true}});
    made.driver = driver;
    if (std::string(driver) == "modbus-tcp") made.settings = {{"address", "a:1"}};
    const auto found = ir::find_fault({made}, nullptr);
    return found ? found->text : std::string();
  };
  using enum ir::DirectArea;
  using ir::PointTable;
  EXPECT_EQ(fault(PointTable::kHolding, kMarker, true, "modbus-tcp-server"), "");
  EXPECT_NE(fault(PointTable::kHolding, kOutput, true, "modbus-tcp"), "");
  EXPECT_NE(fault(PointTable::kHolding, kInput, true, "modbus-tcp-server"), "");
  EXPECT_NE(fault(PointTable::kHolding, kMarker, false, "modbus-tcp-server"), "");
  EXPECT_NE(fault(PointTable::kDiscrete, kOutput, true, "modbus-tcp-server"), "");
}

}  // namespace
}  // namespace vm
