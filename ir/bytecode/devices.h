// Field devices of a program (stc.toml, docs/IO.md): driver, settings, and which points of the
// device are which bits of the process image. Part of the image, so a mapping belongs to a version:
// it is hashed, verified, planned and undone with the code that uses it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/types/types.h"

namespace ir {

enum class DriverId : uint8_t {
#define DRIVER(id, name, family, server, exclusive, meaning) id,
#define TABLE(...)
#define SETTING(...)
#include "ir/bytecode/device_drivers.def"
#undef DRIVER
#undef TABLE
#undef SETTING
};

enum class PointTable : uint8_t {
#define DRIVER(...)
#define TABLE(id, name, families, point_bits, last_point, to_program, to_device, meaning) id,
#define SETTING(...)
#include "ir/bytecode/device_drivers.def"
#undef DRIVER
#undef TABLE
#undef SETTING
};
inline constexpr uint32_t kPointTableCount = 6;

struct DriverRow {
  DriverId id;
  std::string_view name;
  uint32_t family;
  bool server;
  bool exclusive;
  std::string_view meaning;
};
struct TableRow {
  PointTable id;
  std::string_view name;
  uint32_t families;
  uint32_t point_bits;
  uint32_t last_point;
  bool to_program;
  bool to_device;
  std::string_view meaning;
};
enum class SettingKind : uint8_t { kText, kNumber, kLoss, kFlag, kChoice };
struct SettingRow {
  std::string_view key;
  uint32_t families;
  SettingKind kind;
  const char* fallback;  // null: must be given
  int64_t low;
  int64_t high;
  std::string_view meaning;
};
std::span<const DriverRow> driver_rows();
std::span<const TableRow> table_rows();
std::span<const SettingRow> setting_rows();
const DriverRow* find_driver(std::string_view name);  // null: there is none
const SettingRow* find_setting(const DriverRow& driver, std::string_view key);

struct DeviceSetting {
  std::string key;
  std::string value;
  friend bool operator==(const DeviceSetting&, const DeviceSetting&) = default;
};

// `count` points from `first` on are `bits()` of the process image from `at` on; at.bit_size is
// the size of one value there.
struct DeviceMapping {
  PointTable table = PointTable::kBit;
  uint32_t first = 0;
  uint32_t count = 0;
  bool to_device = false;
  DirectAddress at;
  bool writable = false;  // `<->`: others see the program's value and can write it

  uint64_t bits() const;
  friend bool operator==(const DeviceMapping&, const DeviceMapping&) = default;
};

struct Device {
  std::string name;
  std::string driver;
  std::vector<DeviceSetting> settings;  // by key; those that were given
  std::vector<DeviceMapping> map;
  DirectAddress quality;  // an input bit; kNone: none

  friend bool operator==(const Device&, const Device&) = default;
};

// "input 0..3 -> %IW2"
std::string mapping_text(const DeviceMapping& mapping);

// What on_loss says: inputs stay, or become zero so long after the loss; or they stay, and the next
// scan of a task begins with the trap `io-lost`.
struct LossPolicy {
  bool hold = true;
  int64_t zero_after_ns = 0;
  std::string task = {};  // "": none
};
std::optional<LossPolicy> parse_loss(std::string_view text);

// What is wrong with the value; "" when nothing is.
std::string bad_value(const SettingRow& row, std::string_view value);
// Given or fallback, of a checked device.
std::string setting(const Device& device, std::string_view key);
int64_t number_setting(const Device& device, std::string_view key);
bool flag_setting(const Device& device, std::string_view key);

// The first thing wrong with a list of devices, and where: what the compiler and the verifier both
// ask. Process image sizes are checked when they are given.
struct DeviceFault {
  static constexpr size_t kDevice = SIZE_MAX;       // entry: the device itself
  static constexpr size_t kQuality = SIZE_MAX - 1;  // entry: its quality bit
  size_t device = 0;
  size_t entry = kDevice;
  std::string text;
};
struct ProcessImageSize {
  uint32_t input_bytes = 0;
  uint32_t output_bytes = 0;
  uint32_t marker_bytes = 0;
};
std::optional<DeviceFault> find_fault(const std::vector<Device>& devices,
                                      const ProcessImageSize* size);
// May `map` be left out? Then it is the whole process image (a simulated device, shared memory), or
// the usual one of soft PLCs (a Modbus server), which others can write when `writable` says so:
// docs/IO.md.
bool has_default_map(const Device& device);
// Adds the default map for a process image of that size.
void add_default_map(Device& device, const ProcessImageSize& size);
// Bytes of %I, %Q and %M that the devices need.
ProcessImageSize process_image_size(const std::vector<Device>& devices);

}  // namespace ir
