// Boolean logic in a straight line as a series of truth tables: one dispatch for all of it, and no
// branch that depends on what is computed (docs/adr/0028-truth-tables.md). The series stands after
// the units of its POU; vm/load/truth_tables.h makes it.
//
//   in the code:  the first unit has the handler kTruthTables, in `bc` how many units on the
//                 series begins, and in `a` its home
//   the series:   a unit with x: the units of the code that it does, y: how many rows it has;
//                 then the rows, in the order in which they are to be computed
//   a row:        three units (TruthRow)
#pragma once

#include <array>
#include <cstdint>
#include <cstring>

#include "ir/bytecode/code.h"

namespace vm {

inline constexpr uint32_t kTruthInputs = 6;
// Where most variables of a series are: then the first inputs are read from there, whatever the
// rows say, and only the others from a base of their own. kNoHome: all are.
inline constexpr uint32_t kHomeInputs = 4;
using SlotHome = uint16_t;
inline constexpr SlotHome kNoHome = 3;  // else an ir::Base
inline constexpr uint32_t kUnitsOfTruthRow = 3;

// out := bit number (in[0] + 2 in[1] + ... + 32 in[5]) of `table`. All are BOOLs that are clean
// (ir/bytecode/bools.h); inputs that are not needed repeat others.
struct TruthRow {
  uint64_t table = 0;
  std::array<uint16_t, kTruthInputs> in{};  // offsets
  uint16_t out = 0;
  uint16_t bases = 0;  // ir::Base of in[k] in bits 2k and 2k + 1, of `out` in bits 12 and 13
};
static_assert(sizeof(TruthRow) == kUnitsOfTruthRow * sizeof(ir::Unit));

}  // namespace vm
