// Data memory: one reserved range of 4 GiB and a guard, so that no 32-bit offset
// plus a 16-bit displacement can leave it; pages appear when touched. Offsets as
// in ir/bytecode/image.h.
#pragma once

#include <cstdint>
#include <span>

#include "base/result.h"

namespace vm {

class Memory {
 public:
  static base::Result<Memory> reserve();
  Memory(Memory&&) noexcept;
  Memory& operator=(Memory&&) noexcept;
  ~Memory();

  uint8_t* data() { return base_; }
  const uint8_t* data() const { return base_; }
  // The 4 GiB as a span, for symbols and planning.
  std::span<const uint8_t> view() const;

 private:
  explicit Memory(uint8_t* base) : base_(base) {}
  uint8_t* base_ = nullptr;
};

}  // namespace vm
