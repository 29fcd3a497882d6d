#include "base/limits.h"
#include "ir/bytecode/devices.h"

#include <algorithm>
#include <charconv>

namespace ir {
namespace {

enum Family : uint32_t {
  kSimulation = 1,
  kMemory = 2,
  kTcp = 4,
  kRtu = 8,
  kTcpServer = 16,
  kRtuServer = 32,
  kModbus = kTcp | kRtu | kTcpServer | kRtuServer,
  kServers = kTcpServer | kRtuServer,
  kAsking = kSimulation | kMemory | kTcp | kRtu,
  kEvery = kAsking | kServers,
};

bool parse_number(std::string_view text, int64_t& value) {
  const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
  return code == std::errc() && end == text.data() + text.size() && !text.empty();
}

bool is_choice(std::string_view choices, std::string_view value) {
  while (!choices.empty()) {
    const size_t bar = std::min(choices.find('|'), choices.size());
    if (choices.substr(0, bar) == value) return true;
    choices.remove_prefix(std::min(bar + 1, choices.size()));
  }
  return false;
}

}  // namespace

std::span<const DriverRow> driver_rows() {
  static constexpr DriverRow rows[] = {
#define DRIVER(id, name, family, server, exclusive, meaning) \
  {DriverId::id, name, family, server, exclusive, meaning},
#define TABLE(...)
#define SETTING(...)
#include "ir/bytecode/device_drivers.def"
#undef DRIVER
#undef TABLE
#undef SETTING
  };
  return rows;
}

std::span<const TableRow> table_rows() {
  static constexpr TableRow rows[] = {
#define DRIVER(...)
#define TABLE(id, name, families, point_bits, last_point, to_program, to_device, meaning) \
  {PointTable::id, name, families, point_bits, last_point, to_program, to_device, meaning},
#define SETTING(...)
#include "ir/bytecode/device_drivers.def"
#undef DRIVER
#undef TABLE
#undef SETTING
  };
  return rows;
}

std::span<const SettingRow> setting_rows() {
  static constexpr SettingRow rows[] = {
#define DRIVER(...)
#define TABLE(...)
#define SETTING(key, families, kind, fallback, low, high, meaning) \
  {key, families, SettingKind::kind, fallback, low, high, meaning},
#include "ir/bytecode/device_drivers.def"
#undef DRIVER
#undef TABLE
#undef SETTING
  };
  return rows;
}

const DriverRow* find_driver(std::string_view name) {
  for (const DriverRow& row : driver_rows()) {
    if (row.name == name) return &row;
  }
  return nullptr;
}

const SettingRow* find_setting(const DriverRow& driver, std::string_view key) {
  for (const SettingRow& row : setting_rows()) {
    if (row.key == key && (row.families & driver.family) != 0) return &row;
  }
  return nullptr;
}

std::optional<LossPolicy> parse_loss(std::string_view text) {
  constexpr std::string_view kAfter = "zero after ";
  constexpr std::string_view kUnit = " ms";
  constexpr std::string_view kTrap = "trap ";
  constexpr std::string_view kNoName(" \t\0", 3);
  if (text == "hold") return LossPolicy{};
  if (text == "zero") return LossPolicy{false, 0};
  if (text.starts_with(kTrap)) {
    text.remove_prefix(kTrap.size());
    const bool name = !text.empty() && text.size() <= base::kMaxIdentifier &&
                      text.find_first_of(kNoName) == std::string_view::npos;
    return name ? std::optional(LossPolicy{true, 0, std::string(text)}) : std::nullopt;
  }
  if (!text.starts_with(kAfter) || !text.ends_with(kUnit)) return std::nullopt;
  text.remove_prefix(kAfter.size());
  if (text.size() <= kUnit.size()) return std::nullopt;
  text.remove_suffix(kUnit.size());
  int64_t ms = 0;
  if (!parse_number(text, ms) || ms < 0 || ms > 3'600'000) return std::nullopt;
  return LossPolicy{false, ms * 1'000'000};
}

std::string bad_value(const SettingRow& row, std::string_view value) {
  int64_t number = 0;
  switch (row.kind) {
    case SettingKind::kText:
      if (value.size() > base::kMaxIdentifier) return "is too long";
      if (value.find('\0') != std::string_view::npos) return "has a character 0 in it";
      return row.fallback == nullptr && value.empty() ? "is empty" : "";
    case SettingKind::kNumber:
      if (parse_number(value, number) && number >= row.low && number <= row.high) return "";
      return "must be a whole number from " + std::to_string(row.low) + " to " +
             std::to_string(row.high);
    case SettingKind::kLoss:
      return parse_loss(value)
                 ? ""
                 : "must be \"hold\", \"zero\", \"zero after 500 ms\" or \"trap TASK\"";
    case SettingKind::kFlag:
      return value == "true" || value == "false" ? "" : "must be true or false";
    case SettingKind::kChoice:
      break;
  }
  if (is_choice(row.fallback, value)) return "";
  std::string choices = row.fallback;
  std::replace(choices.begin(), choices.end(), '|', ' ');
  return "must be one of: " + choices;
}

std::string setting(const Device& device, std::string_view key) {
  for (const DeviceSetting& given : device.settings) {
    if (given.key == key) return given.value;
  }
  const DriverRow* driver = find_driver(device.driver);
  const SettingRow* row = driver != nullptr ? find_setting(*driver, key) : nullptr;
  if (row == nullptr || row->fallback == nullptr) return {};
  const std::string_view fallback = row->fallback;
  return std::string(fallback.substr(0, fallback.find('|')));
}

int64_t number_setting(const Device& device, std::string_view key) {
  int64_t value = 0;
  parse_number(setting(device, key), value);
  return value;
}

bool flag_setting(const Device& device, std::string_view key) {
  return setting(device, key) == "true";
}

}  // namespace ir
