// Registers and bits of Modbus to exchanged bytes (vm/io/driver.h) and back. A value of several
// registers is little endian bytes here, and high or low register first there.
#pragma once

#include <cstdint>
#include <span>

#include "vm/io/driver.h"

namespace modbus {

// Bytes of register `number` of a range, from the beginning of the range's bytes on.
inline uint32_t byte_of_register(const vm::PointRange& range, uint32_t number, bool high_first) {
  const uint32_t words = range.at.bit_size / 16;
  const uint32_t in_value = number % words;
  return 2 * (number - in_value + (high_first ? words - 1 - in_value : in_value));
}

inline uint16_t get_register(std::span<const uint8_t> bytes, const vm::PointRange& range,
                             uint32_t number, bool high_first) {
  const uint32_t at = range.byte + byte_of_register(range, number, high_first);
  return static_cast<uint16_t>(bytes[at] | bytes[at + 1] << 8);
}

inline void set_register(std::span<uint8_t> bytes, const vm::PointRange& range, uint32_t number,
                         bool high_first, uint16_t value) {
  const uint32_t at = range.byte + byte_of_register(range, number, high_first);
  bytes[at] = static_cast<uint8_t>(value);
  bytes[at + 1] = static_cast<uint8_t>(value >> 8);
}

inline bool get_bit(std::span<const uint8_t> bytes, const vm::PointRange& range, uint32_t number) {
  return (bytes[range.byte + number / 8] >> (number % 8) & 1) != 0;
}

inline void set_bit(std::span<uint8_t> bytes, const vm::PointRange& range, uint32_t number,
                    bool value) {
  const auto mask = static_cast<uint8_t>(1u << (number % 8));
  uint8_t& byte = bytes[range.byte + number / 8];
  byte = static_cast<uint8_t>(value ? byte | mask : byte & ~mask);
}

}  // namespace modbus
