#include "vm/exec/copies.h"

#include "base/limits.h"
#include "stdlib/native/units.h"

namespace vm {
namespace {

template <class Character>
void assign(uint8_t* memory, uint64_t to, uint64_t from) {
  const auto capacity = [](uint64_t reference) {
    return std::min(static_cast<uint32_t>(reference >> 32), base::kMaxStringCapacity);
  };
  stdlib::assign_text<Character>(memory + static_cast<uint32_t>(to), capacity(to),
                                 memory + static_cast<uint32_t>(from), capacity(from));
}

}  // namespace

uint64_t copy_string(uint8_t* memory, uint64_t to, uint64_t from, uint64_t, uint64_t, uint64_t) {
  assign<uint8_t>(memory, to, from);
  return 0;
}

uint64_t copy_wstring(uint8_t* memory, uint64_t to, uint64_t from, uint64_t, uint64_t, uint64_t) {
  assign<uint16_t>(memory, to, from);
  return 0;
}

uint64_t move_bytes(uint8_t* memory, uint64_t to, uint64_t from, uint64_t count, uint64_t,
                    uint64_t) {
  std::memmove(memory + static_cast<uint32_t>(to), memory + static_cast<uint32_t>(from), count);
  return 0;
}

}  // namespace vm
