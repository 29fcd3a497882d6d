// B12 with devices: a task that exchanges by itself, in virtual time and with threads of devices.
#include "tests/unit/io/rig.h"
#include "vm/io/device_io.h"
#include "vm/runtime/clocks.h"
#include "vm/runtime/controller.h"

namespace vm {
namespace {

using io_test::device;
using io_test::FakeDevice;
using io_test::to_device;
using io_test::to_program;

constexpr const char* kTwiceInACycle = R"(
PROGRAM Before VAR n : DINT; END_VAR n := n + 1; END_PROGRAM
PROGRAM Copy VAR i AT %IB0 : BYTE; q AT %QB0 : BYTE; n : DINT; END_VAR q := i; n := n + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PLC
  TASK First (INTERVAL := T#10ms, PRIORITY := 1);
  {attribute 'exchange' := 'own'} TASK Own (INTERVAL := T#10ms, PRIORITY := 2);
  PROGRAM b WITH First : Before; PROGRAM c WITH Own : Copy;
END_RESOURCE END_CONFIGURATION
)";

DriverFactory only(FakeDevice& fake) {
  return [&fake](const ir::Device&) -> base::Result<std::unique_ptr<IoDriver>> {
    return io_test::fake_driver(fake);
  };
}

// The device changes while First runs; Own has that in its scan, and the device has the answer
// before the next cycle. Where no time has passed since the last exchange there is no other one.
TEST(OwnExchangeIo, B12_SimulatedDevicesExchangeWhenTheyAreAsked) {
  FakeDevice fake;
  VirtualClock clock;
  clock.let_scans_last("First", 2'000'000);
  clock.let_scans_last("Own", 3'000'000);
  DeviceIo io({only(fake), {}, &clock});
  auto image = io_test::build(kTwiceInACycle, {device("d", {to_program(0, 1, 0),
                                                            to_device(0, 1, 0)})});
  ASSERT_TRUE(image);
  class Changes : public Timeline {
   public:
    explicit Changes(FakeDevice& device) : fake(device) {}
    void note(Moment moment, std::string_view task, int64_t) override {
      if (moment == Moment::kEnded && task == "First") fake.set(32, ++value);
      if (moment == Moment::kEnded && task == "Own") before = fake.byte(0);
      if (moment == Moment::kSent && task == "Own") sent = fake.byte(0);
    }
    FakeDevice& fake;
    uint8_t value = 100, before = 0, sent = 0;
  };
  Changes changes(fake);
  ControllerOptions options;
  options.timeline = &changes;
  auto controller = Controller::start(*image, options, clock, io);
  ASSERT_TRUE(controller.ok());
  for (uint8_t i = 1; i <= 5; ++i) {
    const int exchanges = fake.exchanges;
    (*controller)->cycle();
    EXPECT_EQ(changes.sent, 100 + i);
    EXPECT_EQ(changes.before, i == 1 ? 0 : 100 + i - 1);
    EXPECT_EQ(fake.exchanges - exchanges, 3);  // of the cycle; at 2 ms; at 5 ms
  }
}

// A device that hangs delays no scan that would exchange with it.
TEST(OwnExchangeIo, B8_B12_ADriverThatHangsDelaysNoScan) {
  FakeDevice fake;
  fake.hangs = true;
  VirtualClock clock;
  DeviceIo io({only(fake)});
  auto image = io_test::build(kTwiceInACycle, {device("d", {to_program(0, 1, 0),
                                                            to_device(0, 1, 0)})});
  ASSERT_TRUE(image);
  {
    auto controller = Controller::start(*image, {}, clock, io);
    ASSERT_TRUE(controller.ok());
    ASSERT_TRUE(io_test::eventually([&] { return fake.exchanges > 0; }));
    const int exchanges = fake.exchanges;
    for (int i = 0; i < 1000; ++i) (*controller)->cycle();
    EXPECT_EQ((*controller)->get("c.n").value(), "1000");
    EXPECT_EQ(fake.exchanges, exchanges);
  }
  fake.hangs = false;
  fake.hangs.notify_all();
}

}  // namespace
}  // namespace vm
