// Calls a native function by its id, directly and by its slots: strings in buffers of exactly their
// capacity plus a NUL, with a guard behind.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "stdlib/native/natives.h"

namespace stdlib::testing {

inline constexpr uint8_t kGuard = 0xA5;

// A scalar, or a string's buffer.
struct NativeArg {
  uint64_t bits = 0;
  uint8_t* data = nullptr;
  uint32_t capacity = 0;
};

// A string variable; `unit` is 1 for STRING and 2 for WSTRING.
class Text {
 public:
  explicit Text(uint32_t capacity, const std::string& value = "", uint32_t unit = 1)
      : capacity_(capacity), unit_(unit), bytes_((size_t{capacity} + 1) * unit) {
    bytes_.resize(bytes_.size() + 8, kGuard);
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

// The bytes of a slot that a letter does not count are arbitrary.
inline uint64_t slot_of(char letter, uint64_t bits) {
  if (letter == 'b') return (bits & 0xFF) | 0xDEADBEEFDEADBE00u;
  if (letter == 'i' || letter == 'f') return (bits & 0xFFFFFFFFu) | 0xDEADBEEF00000000u;
  return bits;
}
inline uint64_t counted(char letter, uint64_t bits) {
  if (letter == 'b') return bits & 0xFF;
  if (letter == 'i') return static_cast<uint64_t>(static_cast<int64_t>(static_cast<int32_t>(bits)));
  return letter == 'f' ? bits & 0xFFFFFFFFu : bits;
}

// In a copy of all strings, one behind the other; what the two ways of calling give must agree.
inline uint64_t call(NativeId id, const std::vector<NativeArg>& args) {
  const auto number = static_cast<uint32_t>(id);
  const NativeRow& row = native_row(number);
  EXPECT_EQ(row.arguments.size(), args.size());
  std::vector<uint8_t> memory;
  std::vector<uint64_t> slots(std::max<size_t>(args.size(), kDirectArguments));
  std::vector<size_t> sizes(args.size());
  for (size_t i = 0; i < args.size(); ++i) {
    slots[i] = slot_of(row.arguments[i], args[i].bits);
    if (args[i].data == nullptr) continue;
    slots[i] = memory.size() | uint64_t{args[i].capacity} << 32;
    sizes[i] = (size_t{args[i].capacity} + 1) * (row.arguments[i] == 'W' ? 2 : 1);
    memory.insert(memory.end(), args[i].data, args[i].data + sizes[i]);
  }
  std::vector<uint8_t> other = memory;
  const bool direct = args.size() <= kDirectArguments;
  const uint64_t first = direct ? slots[0] : reinterpret_cast<uintptr_t>(slots.data());
  const uint64_t result =
      row.function(memory.data(), first, slots[1], slots[2], slots[3], slots[4]);
  for (size_t i = 0; i < args.size(); ++i) {
    if (args[i].data == nullptr) continue;
    std::copy_n(memory.begin() + static_cast<uint32_t>(slots[i]), sizes[i], args[i].data);
  }
  kNativeSlots[number](other.data(), reinterpret_cast<uint8_t*>(slots.data()));
  EXPECT_EQ(memory, other) << row.name;
  if (row.result == 'v') return result;
  EXPECT_EQ(counted(row.result, result), counted(row.result, slots[0])) << row.name;
  return counted(row.result, result);
}

}  // namespace stdlib::testing
