// V14 for devices: what an image says of them is checked as the compiler does, whoever made it.
#include "ir/bytecode/devices.h"

#include <gtest/gtest.h>

#include <random>

#include "base/limits.h"
#include "ir/bytecode/verify.h"
#include "ir/types/address_text.h"
#include "sample_image.h"

namespace ir {
namespace {

Device simulated(std::vector<DeviceMapping> map) {
  return {"press", "simulated", {}, std::move(map), {}};
}

DeviceMapping input(uint32_t first, uint32_t count, uint32_t byte) {
  return {PointTable::kByte, first, count, false, {DirectArea::kInput, byte * 8, 8}};
}

base::Result<VerifiedImage> verified(const std::vector<Device>& devices) {
  Image image = sample::busy_image();
  image.input_bytes = std::max<uint32_t>(image.input_bytes, 16);
  image.output_bytes = std::max<uint32_t>(image.output_bytes, 16);
  image.devices = devices;
  return verify(encode(image));
}

void expect_refused(const std::vector<Device>& devices, const std::string& text) {
  const base::Result<VerifiedImage> image = verified(devices);
  ASSERT_FALSE(image.ok()) << text;
  EXPECT_EQ(image.error().refusal, base::Refusal::kBadDevice) << image.error().text;
  EXPECT_NE(image.error().text.find(text), std::string::npos) << image.error().text;
}

TEST(Devices, SurviveEncoding) {
  Device device = simulated({input(0, 4, 0)});
  device.settings = {{"on_loss", "zero after 500 ms"}, {"period_ms", "20"}};
  device.quality = {DirectArea::kInput, 15 * 8 + 7, 1};
  const base::Result<VerifiedImage> image = verified({device});
  ASSERT_TRUE(image.ok()) << image.error().text;
  ASSERT_EQ(image->image().devices.size(), 1u);
  EXPECT_TRUE(image->image().devices[0] == device);
  EXPECT_EQ(number_setting(device, "period_ms"), 20);
  EXPECT_EQ(number_setting(device, "timeout_ms"), 200);
}

// Whoever asks a server may take a second for all of its devices.
TEST(Devices, AServerWaitsLongerThanAClient) {
  for (const char* const driver : {"modbus-tcp-server", "modbus-rtu-server"}) {
    Device device = simulated({});
    device.driver = driver;
    EXPECT_EQ(number_setting(device, "timeout_ms"), 2000);
  }
}

TEST(Devices, V14_RangesOutsideTheProcessImageAreRefused) {
  EXPECT_TRUE(verified({simulated({input(0, 16, 0)})}).ok());
  expect_refused({simulated({input(0, 17, 0)})}, "ends at byte 17 of 16");
  expect_refused({simulated({input(0, 1, 16)})}, "ends at byte 17 of 16");
  expect_refused({simulated({input(0, 1, base::kMaxDeviceBytes)})}, "the limit is 1048576");
  expect_refused({simulated({input(0, 65536, base::kMaxDeviceBytes - 65535)})}, "the limit is");
  Device quality = simulated({});
  quality.quality = {DirectArea::kInput, 16 * 8, 1};
  expect_refused({quality}, "ends at byte 17 of 16");
  quality.quality = {DirectArea::kOutput, 0, 1};
  expect_refused({quality}, "the quality is a bit of %I");
}

TEST(Devices, V14_WhatHasNoMeaningIsRefused) {
  expect_refused({{"x", "carrier-pigeon", {}, {}, {}}}, "there is no driver");
  expect_refused({simulated({}), simulated({})}, "another device `press`");
  expect_refused({simulated({input(0, 0, 0)})}, "no points");
  expect_refused({simulated({input(65535, 2, 0)})}, "`byte` ends at 65535");
  expect_refused({simulated({input(UINT32_MAX, UINT32_MAX, 0)})}, "`byte` ends at 65535");
  DeviceMapping odd = input(0, 2, 0);
  odd.at.bit_offset = 3;
  expect_refused({simulated({odd})}, "no address");
  odd = input(0, 2, 0);
  odd.at.bit_size = 7;
  expect_refused({simulated({odd})}, "no address");
  odd = input(0, 2, 0);
  odd.at.area = DirectArea::kNone;
  expect_refused({simulated({odd})}, "no address");
  Device settings = simulated({});
  settings.settings = {{"speed", "9"}};
  expect_refused({settings}, "has no setting `speed`");
  settings.settings = {{"period_ms", "-1"}};
  expect_refused({settings}, "whole number from 1");
  expect_refused({{"m", "modbus-tcp", {}, {}, {}}}, "needs `address`");
}

TEST(Devices, V14_ALossThatTrapsNoTaskIsRefused) {
  Device device = simulated({input(0, 4, 0)});
  for (const char* good : {"trap Fast", "trap FAST"}) {
    device.settings = {{"on_loss", good}};
    EXPECT_TRUE(verified({device}).ok()) << good;
  }
  device.settings = {{"on_loss", "trap Fas"}};
  expect_refused({device},
                 "`on_loss` names `Fas`, which is no task that runs a program; there is `Fast`");
  for (const char* bad : {"trap", "trap ", "trap  Fast", "trap Fast ", "trapFast"}) {
    device.settings = {{"on_loss", bad}};
    expect_refused({device}, "or \"trap TASK\"");
  }
  device.settings = {{"on_loss", "trap " + std::string(base::kMaxIdentifier, 'x')}};
  expect_refused({device}, "is no task");
  device.settings = {{"on_loss", "trap " + std::string(base::kMaxIdentifier + 1, 'x')}};
  expect_refused({device}, "or \"trap TASK\"");
  device.settings = {{"on_loss", std::string("trap F\0", 7)}};
  EXPECT_EQ(verified({device}).error().refusal, base::Refusal::kBadFormat);  // no text at all
}

// What has no scans of its own cannot be trapped.
TEST(Devices, V14_ALossTrapsATaskWithAProgram) {
  Image image = sample::busy_image();
  image.input_bytes = 16;
  image.tasks.push_back({"Empty", 10'000'000, 100'000'000, 2, 0, {}});
  image.devices = {simulated({input(0, 4, 0)})};
  EXPECT_TRUE(verify(encode(image)).ok());
  image.devices[0].settings = {{"on_loss", "trap Empty"}};
  const base::Result<VerifiedImage> refused = verify(encode(image));
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kBadDevice);
}

TEST(Devices, OverlapsAreRefused) {
  EXPECT_TRUE(verified({simulated({input(0, 4, 0), input(4, 4, 4)})}).ok());
  expect_refused({simulated({input(0, 4, 0), input(8, 4, 3)})}, "provides the same bits of %I");
  expect_refused({simulated({input(0, 4, 0), input(3, 4, 4)})}, "takes the same points");
  // A wide claim hides a narrow one that begins behind others.
  expect_refused({simulated({input(0, 12, 0), input(20, 1, 2), input(30, 1, 5)})}, "same bits");
  const DeviceMapping out{PointTable::kByte, 0, 4, true, {DirectArea::kOutput, 0, 8}};
  EXPECT_TRUE(verified({simulated({input(0, 4, 0), out})}).ok());  // reading back is no overlap
  expect_refused({simulated({out, out})}, "takes the same points");
}

TEST(Devices, AtTheLimitAndAbove) {
  std::vector<Device> devices;
  for (uint32_t i = 0; i < base::kMaxDevices; ++i) {
    devices.push_back(simulated({}));
    devices.back().name += std::to_string(i);
  }
  EXPECT_FALSE(find_fault(devices, nullptr).has_value());
  devices.push_back(simulated({}));
  ASSERT_TRUE(find_fault(devices, nullptr).has_value());
  EXPECT_NE(find_fault(devices, nullptr)->text.find("more than 64 devices"), std::string::npos);
  std::vector<DeviceMapping> map;
  for (uint32_t i = 0; i < base::kMaxMappings; ++i) map.push_back(input(i, 1, i));
  EXPECT_FALSE(find_fault({simulated(map)}, nullptr).has_value());
  map.push_back(input(base::kMaxMappings, 1, base::kMaxMappings));
  ASSERT_TRUE(find_fault({simulated(map)}, nullptr).has_value());
}

// Whatever the numbers are: an answer, and what is accepted lies inside the limits.
TEST(Devices, SurviveNonsense) {
  std::mt19937 random(3);
  const uint32_t numbers[] = {0, 1, 7, 8, 16, 31, 32, 64, 65535, 65536, 1u << 23, UINT32_MAX};
  const auto number = [&] { return numbers[random() % std::size(numbers)]; };
  const char* drivers[] = {"simulated", "modbus-tcp-server", "modbus-rtu-server", "shared-memory"};
  int good = 0;
  for (int round = 0; round < 20'000; ++round) {
    Device device{"d", drivers[random() % 4], {}, {}, {}};
    if (random() % 2 == 0) device.settings = {{"name", "/x"}};
    if (device.driver == "modbus-rtu-server") device.settings = {{"port", "/dev/x"}};
    for (uint32_t i = random() % 3; i != 0; --i) {
      device.map.push_back({static_cast<PointTable>(random() % kPointTableCount),
                            number(),
                            number(),
                            random() % 2 == 0,
                            {static_cast<DirectArea>(random() % 4), number(), number()},
                            random() % 2 == 0});
    }
    device.quality = {static_cast<DirectArea>(random() % 4), number(), number()};
    if (find_fault({device}, nullptr)) continue;
    ++good;
    const ProcessImageSize size = process_image_size({device});
    EXPECT_LE(size.input_bytes, base::kMaxDeviceBytes);
    EXPECT_LE(size.output_bytes, base::kMaxDeviceBytes);
    EXPECT_LE(size.marker_bytes, base::kMaxDeviceBytes);
  }
  EXPECT_GT(good, 100);
}

// The usual map of a server: others read all of it, and write where `writable` says so.
TEST(Devices, OthersMayWriteOnlyWhereTheMapSaysSo) {
  for (const char* writable : {"", "false", "true"}) {
    Device device{"hmi", "modbus-tcp-server", {}, {}, {}};
    if (*writable != 0) device.settings = {{"writable", writable}};
    add_default_map(device, {16, 16, 16});
    int outside = 0;
    for (const DeviceMapping& mapping : device.map) {
      EXPECT_TRUE(mapping.to_device);
      outside += mapping.writable ? 1 : 0;
    }
    EXPECT_EQ(device.map.size(), 6u);
    EXPECT_EQ(outside, std::string(writable) == "true" ? 4 : 0) << writable;
    EXPECT_FALSE(find_fault({device}, nullptr).has_value());
  }
  expect_refused({{"hmi", "modbus-tcp-server", {{"writable", "yes"}}, {}, {}}},
                 "must be true or false");
}

TEST(Devices, AddressesAsText) {
  for (const char* text : {"%IX0.0", "%QX12.7", "%IB3", "%QW4", "%MD10", "%IL2"}) {
    const auto address = parse_address(text);
    ASSERT_TRUE(address.has_value()) << text;
    EXPECT_EQ(address_text(*address), text);
  }
  EXPECT_EQ(parse_address("%i0.3")->bit_offset, 3u);
  EXPECT_EQ(parse_address("%QW4")->bit_offset, 64u);
  for (const char* text : {"", "%", "%I", "IX0.0", "%IX0", "%IX0.8", "%IW2.0", "%AW2", "%IW",
                           "%IW-1", "%IW99999999999", "%IL4294967295", "%IW2 ", "%IX536870911.7"}) {
    EXPECT_FALSE(parse_address(text).has_value()) << text;
  }
}

// No rule bounds the size of a member's address, so an image can say anything.
TEST(Addresses, OfNoSizeHaveATextToo) {
  EXPECT_EQ(address_text({DirectArea::kOutput, 19, 0}), "%QX2.3");
}

}  // namespace
}  // namespace ir
