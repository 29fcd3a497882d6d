// Frame of a POU: parameters in declaration order, then scalars, then scratch
// slots for far operands, then aggregates. The callee's frame begins where this
// one ends.
#pragma once

#include <cstdint>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "ir/bytecode/object.h"

namespace linker {

// A slot through which an operand goes that 16 bits do not reach.
struct Scratch {
  ir::Class cls = ir::Class::kB;
  ir::Region region;     // kA
  uint8_t position = 0;  // operand field 0..2
  friend bool operator==(const Scratch&, const Scratch&) = default;
};

struct FrameLayout {
  std::vector<uint64_t> offsets;          // by object slot; arguments in the next frame: unused
  std::vector<uint32_t> scratch_offsets;  // parallel to the scratch list
  std::vector<ir::FrameSlot> slots;       // sorted by offset
  std::vector<uint32_t> slot_numbers;     // object slot -> slots; kNoSlot for arguments
  uint32_t size = 0;
};
inline constexpr uint32_t kNoSlot = 0xffffffffu;

base::Result<FrameLayout> lay_out_frame(const ir::Object& object, const ir::Layouts& layouts,
                                        const std::vector<Scratch>& scratch);

}  // namespace linker
