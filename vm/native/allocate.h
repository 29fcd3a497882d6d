// Registers for the values of a Function.
//
// One pass over the blocks in their order. Inside of a block a register is taken from the value
// whose next use is farthest away; a value whose variable still holds it in memory, and a constant,
// need no store for that. A loop begins with the values in registers that its body uses first.
// Where ways meet, moves on the edges bring every value to where the block expects it.
//
// A value is in one register at most, and beside that in its spill slot (of the machine's stack),
// in the memory of its variable ("home"), or nowhere.
#pragma once

#include <array>
#include <vector>

#include "base/check.h"
#include "base/result.h"
#include "vm/native/lir.h"

namespace vm::native {

struct Place {
  enum Kind : uint8_t { kNowhere, kRegister, kSpill, kConstant, kHome };
  Kind kind = kNowhere;
  bool floating = false;  // of a register
  bool clean = false;     // kHome of a BOOL: it is 0 or 1
  uint32_t number = 0;    // register, spill slot, variable
  uint64_t bits = 0;      // kConstant
  friend bool operator==(const Place&, const Place&) = default;
};

struct Move {
  Place to;  // kRegister or kSpill
  Place from;
  uint8_t width = 8;  // of a constant
};

// A node with its places, or (`node` is kNone) a move.
struct Step {
  uint32_t node = kNone;
  Place result;
  Place in[4];
  Place index;
  Place pointer;
  Move move;
};

struct AllocatedBlock {
  std::vector<Step> steps;
  Place in[2];  // of the end
  std::vector<Move> edges[2];
  std::vector<Move> resume;  // of a loop head: from the interpreter's state
};

struct Allocated {
  std::vector<AllocatedBlock> blocks;
  std::vector<std::vector<Place>> exits;  // parallel to Function::exits and their slots
  uint32_t spill_slots = 0;               // of 8 bytes
};

// What the machine demands of one operation. Registers by number; -1: any.
struct Demands {
  int8_t in[4] = {-1, -1, -1, -1};
  int8_t result = -1;
  uint32_t clobbers = 0;  // integer registers that it destroys
  uint32_t clobbers_floats = 0;
  uint8_t shares = 0xff;  // operands whose register the result may take: bit i; 0x10: the index
  bool clobbers_all = false;
  bool wants(uint32_t reg) const {
    for (const int8_t fixed : in) {
      if (fixed == static_cast<int>(reg)) return true;
    }
    return false;
  }
};

class Target {
 public:
  virtual ~Target() = default;
  virtual Demands demands(const Function& f, const Node& node) const = 0;
  // May the operand be a constant in the instruction, or be read from memory by it?
  virtual bool takes_constant(const Function& f, const Node& node, uint32_t operand) const = 0;
  virtual bool takes_memory(const Function& f, const Node& node, uint32_t operand) const = 0;
  // The operand that the operation can read from any memory; -1: none.
  virtual int folds(const Node&) const { return -1; }
  // May in[0] be read from memory, where a BOOL is any byte?
  virtual bool end_takes_memory(const Function&, const End&) const { return false; }
  virtual bool end_takes_constant(const Function& f, const End& end, uint32_t operand) const = 0;
  uint32_t integers = 0;  // registers
  uint32_t floats = 0;
};

// Loads that one operation alone wants, close after them, become a part of it. The last pass.
void fold_loads(Function& function, const Target& target);

struct AllocatorOptions {
  uint32_t integers = 0;  // at most; 0: all of the target
  uint32_t floats = 0;
  uint64_t spill_seed = 0;  // not 0: registers are taken at random
};

base::Result<Allocated> allocate(const Function& function, const Target& target,
                                 const AllocatorOptions& options);

// Has everything that is emitted a place that exists? allocate() promises it, and emitters rely on
// it (base/check.h). Linear in the steps.
bool has_places(const Function& function, const Allocated& all);
inline void expect_places(const Function& function, const Allocated& all) {
  base::dcheck([&] { return has_places(function, all); }, "every value that is used has a place");
}

// A register that nothing else uses; a target knows it by its number.
inline constexpr uint32_t kMostRegisters = 32;
inline constexpr Place kAside{Place::kRegister, true, false, kMostRegisters, 0};

// One after the other, so that nothing is overwritten that a later one reads. `aside` stands for a
// register that nothing else uses.
std::vector<Move> in_sequence(std::vector<Move> moves, Place aside);

}  // namespace vm::native
