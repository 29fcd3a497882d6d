// What writes machine code of functions, and what it is told of them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "ir/bytecode/code.h"
#include "vm/native/allocate.h"

namespace vm::native {

// Units that the interpreter executes for native code, at a fixed place: for a helper
// its unit and a stop, for a call its unit and one that comes back here.
struct SideUnits {
  std::unique_ptr<ir::Unit[]> units;
  uint32_t count = 0;
  std::vector<uint32_t> real;    // by side unit: the POU's unit
  std::vector<uint32_t> helper;  // by node: index into units; kNone
  std::vector<uint32_t> call;    // by call: its unit
  std::vector<uint32_t> resume;  // by call: the one that comes back
};

// Where machine code can be entered, in bytes from the beginning of the code.
struct Entries {
  uint32_t begin = 0;
  std::vector<uint32_t> behind_call;              // by call
  std::vector<std::pair<Block, uint32_t>> heads;  // of loops
};

struct PouCode {
  const Function* function = nullptr;
  const Allocated* places = nullptr;
  const SideUnits* side = nullptr;
  const ir::Unit* units = nullptr;  // the POU's own, ready for the interpreter
  uint32_t number = 0;
  bool plain = false;       // nothing that only newer machines have
  uint32_t table_ways = 0;  // a jump table for so many ways; 0: where it pays
};

}  // namespace vm::native
