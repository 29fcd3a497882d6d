// The optimiser: passes over the IR of a program, between the front end and ir/lower. What a
// program does stays the same to the bit: values, traps with their POU and line, and every store
// before a trap, a call or a back edge. No pass makes more bytecode: a load of a variable
// is an operand in bytecode and costs nothing, so nothing is kept in a temporary to save one.
// Deterministic: the same program gives the same result, on any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

enum class Pass : uint8_t {
#define PASS(id, name, function, what) id,
#include "ir/opt/passes.def"
#undef PASS
};

struct PassRow {
  std::string_view name;
  std::string_view what;
};
std::span<const PassRow> pass_rows();  // by number

class PassSet {
 public:
  static PassSet none() { return PassSet(); }
  static PassSet all();
  // "fold,dead", "all" or "none"; kUsage with the known names.
  static base::Result<PassSet> parse(std::string_view text);
  static PassSet from_bits(uint32_t bits);  // bits above the last pass do not count
  std::string text() const;                 // parse(text()) is the same set

  bool has(Pass pass) const { return (bits_ >> static_cast<uint32_t>(pass) & 1) != 0; }
  bool empty() const { return bits_ == 0; }

 private:
  uint32_t bits_ = 0;
};

// kInternal when `verify_each` finds that a pass left a POU unsound, with the name of the pass;
// nothing else fails. POUs are optimised on up to `jobs` threads.
base::Status optimise(Program& program, PassSet passes, bool verify_each, uint32_t jobs = 1);

// One POU that is not optimised yet; what it calls is. The result is that of the whole.
base::Status optimise(Program& program, PouId pou, PassSet passes, bool verify_each);
// May calls of this function become its body?
bool can_be_inlined(const Program& program, PouId pou);

}  // namespace ir
