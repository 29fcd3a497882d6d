// A store of a POU's version that may write forced variables (vm/load/forced_code.h), beside the
// code: it is executed there, the variables get their forced values again, and the POU goes on
// after it. There is no safe point in between.
#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "ir/bytecode/code.h"

namespace vm {

// `mask` is not 0: only these bits of one byte.
inline void put_value(uint8_t* to, const uint8_t* bytes, size_t size, uint8_t mask) {
  if (mask == 0) {
    std::memcpy(to, bytes, size);
  } else {
    *to = static_cast<uint8_t>((*to & ~mask) | (*bytes & mask));
  }
}

struct StoreAside {
  struct Value {
    uint32_t data = 0;  // in data memory
    uint32_t size = 0;
    const uint8_t* bytes = nullptr;
    uint8_t mask = 0;
  };
  ir::Unit units[3];  // the store, decoded, and after it one that restores
  const ir::Unit* back = nullptr;
  std::vector<Value> values;
};

// A unit whose bits 16 to 63 are the address of a StoreAside; its handler is kAsideHandler or
// kRestoreHandler. What it says stays where it is.
inline ir::Unit aside_unit(uint32_t handler, const StoreAside& aside) {
  const uint64_t bits = reinterpret_cast<uint64_t>(&aside) << 16 | handler;
  ir::Unit unit;
  std::memcpy(static_cast<void*>(&unit), &bits, sizeof unit);
  return unit;
}
inline const StoreAside& aside_of(const ir::Unit* unit) {
  uint64_t bits;
  std::memcpy(&bits, unit, sizeof bits);
  return *reinterpret_cast<const StoreAside*>(bits >> 16);
}

}  // namespace vm
