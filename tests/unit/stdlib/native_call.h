// Calls a native function by its id as the machine does: arguments by signature
// letters, strings in buffers of exactly their capacity plus a NUL, with a guard behind.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "stdlib/native/natives.h"

namespace stdlib::testing {

inline constexpr uint8_t kGuard = 0xA5;

// A string variable; `unit` is 1 for STRING and 2 for WSTRING.
class Text {
 public:
  explicit Text(uint32_t capacity, const std::string& value = "", uint32_t unit = 1)
      : capacity_(capacity), unit_(unit), bytes_((capacity + 1) * unit + 8, kGuard) {
    std::fill(bytes_.begin(), bytes_.end() - 8, uint8_t{0});
    for (uint32_t i = 0; i < value.size() && i < capacity + 1; ++i) {
      bytes_[i * unit] = static_cast<uint8_t>(value[i]);
    }
  }
  NativeArg arg() { return {0, bytes_.data(), capacity_}; }
  void set_unit(uint32_t index, uint16_t code) {
    bytes_[index * unit_] = static_cast<uint8_t>(code);
    if (unit_ == 2) {
      bytes_[index * unit_ + 1] = static_cast<uint8_t>(code >> 8);
    }
  }
  // Up to the NUL, which must be there; low bytes only.
  std::string value() const {
    for (size_t i = bytes_.size() - 8; i < bytes_.size(); ++i) {
      EXPECT_EQ(bytes_[i], kGuard) << "written behind the string";
    }
    std::string result;
    for (uint32_t i = 0; i <= capacity_; ++i) {
      if (bytes_[i * unit_] == 0 && (unit_ == 1 || bytes_[i * unit_ + 1] == 0)) {
        return result;
      }
      result.push_back(static_cast<char>(bytes_[i * unit_]));
    }
    ADD_FAILURE() << "no NUL within the capacity";
    return result;
  }

 private:
  uint32_t capacity_;
  uint32_t unit_;
  std::vector<uint8_t> bytes_;
};

inline NativeArg number(int64_t value) { return {static_cast<uint64_t>(value), nullptr, 0}; }

inline uint64_t call(NativeId id, std::vector<NativeArg> args) {
  const NativeRow& row = native_row(static_cast<uint32_t>(id));
  EXPECT_EQ(row.arguments.size(), args.size());
  return row.function(args.data());
}

}  // namespace stdlib::testing
