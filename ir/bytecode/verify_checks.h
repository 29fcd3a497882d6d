// What the check of code must know of an opcode, gathered from its row of opcodes.def: a line of a
// table instead of questions at every instruction.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "ir/bytecode/code.h"

namespace ir::verification {

struct OperandCheck {
  Class cls = Class::kB;
  bool reads = false;
  bool writes = false;
};

struct OpcodeChecks {
  // What the instruction leaves unused is zero: these bits of its units.
  uint64_t first = 0;
  uint64_t second = 0;
  // Which bases it may have, as a bit for each value of the three fields together.
  uint64_t bases = 0;
  OperandCheck a, b, c;
  bool extended = false;
  bool ends = false;
  bool calls = false;  // POUs, or what is native
  // The instruction reads scalars and writes one, in places that it names itself, and nothing else:
  // no address, no string, no jump, no table.
  bool plain = false;
};

// By opcode number; of the process.
const std::array<OpcodeChecks, kOpcodeCount>& opcode_checks();

inline uint64_t bits_of(const Unit& unit) {
  uint64_t bits;
  std::memcpy(&bits, &unit, sizeof bits);
  return bits;
}

}  // namespace ir::verification
