// B9: each device has buffers of its own for both ways. In virtual time: what is sent and received
// is exchanged at once.
#include "tests/unit/io/rig.h"
#include "vm/io/device_io.h"
#include "vm/runtime/clocks.h"

namespace vm {
namespace {

using io_test::device;
using io_test::FakeDevice;
using io_test::to_device;
using io_test::to_program;

TEST(DeviceBuffers, B9_WhatOneDeviceGetsAndGivesIsItsOwn) {
  FakeDevice left;
  FakeDevice right;
  VirtualClock clock;
  const DriverFactory by_name = [&](const ir::Device& wanted) {
    return base::Result<std::unique_ptr<IoDriver>>(
        io_test::fake_driver(wanted.name == "left" ? left : right));
  };
  DeviceIo io({by_name, {}, &clock});
  auto image = io_test::build(
      "PROGRAM P VAR i AT %IB0 : BYTE; j AT %IB1 : BYTE; q AT %QB0 : BYTE; r AT %QB1 : BYTE; "
      "END_VAR q := i; r := j; END_PROGRAM",
      {device("left", {to_program(0, 1, 0), to_device(0, 1, 0)}),
       device("right", {to_program(5, 1, 1), to_device(7, 1, 1)})});
  ASSERT_TRUE(image);
  ASSERT_TRUE(io.prepare(*image).ok());
  io.use(image->digest());
  base::Bytes inputs(image->image().input_bytes);
  const auto exchange = [&](base::Bytes outputs) {
    clock.advance(10'000'000);
    io.send(outputs);
    io.receive(inputs);
  };
  left.set(32, 11);
  right.set(37, 22);
  exchange({33, 44});
  EXPECT_EQ(inputs[0], 11);
  EXPECT_EQ(inputs[1], 22);
  EXPECT_EQ(left.byte(0), 33);
  EXPECT_EQ(left.byte(7), 0);
  EXPECT_EQ(right.byte(7), 44);
  EXPECT_EQ(right.byte(0), 0);
  left.broken = true;  // and the other goes on
  left.set(32, 12);
  right.set(37, 23);
  exchange({34, 45});
  EXPECT_EQ(inputs[1], 23);
  EXPECT_EQ(right.byte(7), 45);
  EXPECT_EQ(left.byte(0), 33);
  EXPECT_EQ(io.status()[0].state, "lost");
  EXPECT_EQ(io.status()[1].state, "online");
  left.broken = false;
  exchange({35, 46});
  EXPECT_EQ(inputs[0], 12);
  EXPECT_EQ(left.byte(0), 35);
  EXPECT_EQ(right.byte(7), 46);
}

}  // namespace
}  // namespace vm
