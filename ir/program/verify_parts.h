// The parts of verify.h, each over what the earlier ones have checked.
#pragma once

#include <set>
#include <utility>

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

inline base::Error not_verified(std::string text) {
  return {base::Refusal::kInternal, std::move(text)};
}

// Every type refers to existing types, nests finitely and has a size below the limits.
base::Status verify_types(const TypeTable& types);

// Do constants fit the types that they initialise? Answers are kept per pair, so
// shared subtrees are visited once.
class ConstantCheck {
 public:
  ConstantCheck(const TypeTable& types, const ConstTable& constants)
      : types_(types), constants_(constants) {}
  base::Status fits(TypeId type, ConstId constant);  // invalid constants fit everything

 private:
  struct Pair {
    TypeId type;
    ConstId constant;
  };
  base::Status push_elements(const Pair& pair);

  const TypeTable& types_;
  const ConstTable& constants_;
  std::set<std::pair<uint32_t, uint32_t>> known_;
  std::vector<Pair> open_;
};

// Instructions one by one: operands, scalars, places, targets.
base::Status verify_instructions(const Program& program, const Pou& pou);
// Every use is dominated by its definition.
base::Status verify_dominance(const Pou& pou);
// Blocks and the handlers that they name, see "Caught traps" in ir.h.
base::Status verify_tries(const Pou& pou);
// Calls of functions and methods, see "Calls" in ir.h.
base::Status verify_calls(const Program& program, const Pou& pou);

// "POU Main, b2, instruction 3 (add, line 17): "
std::string inst_place(const Pou& pou, size_t block, size_t inst);

// Values that an instruction uses, those inside its places included.
ValueList used_values(const Pou& pou, const Inst& inst);

}  // namespace ir
