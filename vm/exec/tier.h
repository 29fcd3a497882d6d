// How code is executed. The tiers do the same, bit for bit.
#pragma once

#include <cstdint>

namespace vm {

enum class Tier : uint8_t {
  kAuto,  // native code where the machine has it
  kInterpreter,
  kNative,  // the same as kAuto
};

// Do several instructions in a row share a handler (vm/exec/fusion.h)?
enum class Fusing : uint8_t {
  kAuto,  // where everything is interpreted
  kNever,
  kAlways,  // also what the interpreter does for native code
};

// When is machine code of the first version made? That of later ones is there when they are
// prepared, if that of the one before them is.
enum class Making : uint8_t {
  kAtOnce,
  kBeside,  // by another thread, while the program is interpreted (vm/runtime/controller.h)
};

struct TierOptions {
  Tier tier = Tier::kAuto;
  Fusing fusing = Fusing::kAuto;
  Making making = Making::kAtOnce;
  // Hard modes (docs/TESTING.md).
  uint32_t integer_registers = 0;  // at most so many; 0: all
  uint32_t float_registers = 0;
  uint64_t spill_seed = 0;   // not 0: registers are taken from values at random
  uint64_t fusing_seed = 0;  // not 0: at every other place, at random
  bool alternates = false;   // every other generation is interpreted
  uint64_t pou_seed = 0;     // not 0: every other POU is interpreted, at random
  uint64_t take_at = 0;      // not 0: what was made beside is taken when this cycle begins
  bool plain = false;        // no instructions that only newer machines have
  uint32_t table_ways = 0;   // a jump table for so many ways; 0: where it pays
  uint32_t logic_line = 0;   // truth tables for so many instructions; 0: where they pay
};

}  // namespace vm
