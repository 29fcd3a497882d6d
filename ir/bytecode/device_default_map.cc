#include <algorithm>

#include "ir/bytecode/devices.h"

namespace ir {
namespace {

constexpr uint32_t kAllPoints = 65536;
constexpr uint32_t kWords = 1024;  // holding registers for %QW, and as many after them for %MW

void add(Device& device, PointTable table, uint32_t first, uint32_t count, bool to_device,
         DirectAddress at, bool writable = false) {
  if (count != 0) device.map.push_back({table, first, count, to_device, at, writable});
}

uint32_t points(uint32_t bytes, uint32_t per_byte) {
  return std::min<uint64_t>(uint64_t{bytes} * per_byte, kAllPoints);
}

}  // namespace

bool has_default_map(const Device& device) {
  const DriverRow* driver = find_driver(device.driver);
  if (driver == nullptr) return false;
  return driver->server || driver->id == DriverId::kSimulated ||
         driver->id == DriverId::kSharedMemory;
}

void add_default_map(Device& device, const ProcessImageSize& size) {
  const DirectAddress in{DirectArea::kInput, 0, 8};
  const DirectAddress out{DirectArea::kOutput, 0, 8};
  if (!find_driver(device.driver)->server) {
    add(device, PointTable::kByte, 0, std::min(size.input_bytes, kAllPoints), false, in);
    add(device, PointTable::kByte, 0, std::min(size.output_bytes, kAllPoints), true, out);
    return;
  }
  const bool writable = flag_setting(device, "writable");
  const auto registers = [](uint32_t bytes, uint32_t most) {
    return std::min(bytes / 2 + bytes % 2, most);
  };
  add(device, PointTable::kCoil, 0, points(size.output_bytes, 8), true, {DirectArea::kOutput, 0, 1},
      writable);
  add(device, PointTable::kDiscrete, 0, points(size.input_bytes, 8), true,
      {DirectArea::kInput, 0, 1});
  add(device, PointTable::kInput, 0, registers(size.input_bytes, kAllPoints), true,
      {DirectArea::kInput, 0, 16});
  add(device, PointTable::kHolding, 0, registers(size.output_bytes, kWords), true,
      {DirectArea::kOutput, 0, 16}, writable);
  add(device, PointTable::kHolding, kWords, registers(size.marker_bytes, kWords), true,
      {DirectArea::kMarker, 0, 16}, writable);
  const uint32_t doubles = (size.marker_bytes + 3) / 4;
  add(device, PointTable::kHolding, 2 * kWords,
      2 * std::min(doubles, (kAllPoints - 2 * kWords) / 2), true, {DirectArea::kMarker, 0, 32},
      writable);
}

}  // namespace ir
