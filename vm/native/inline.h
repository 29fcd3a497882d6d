// Bodies of small POUs in the place of their calls.
//
// What is there is what the call would do: arguments and results travel through the callee's frame,
// fuel is taken, and an exit inside makes the callee's activation as if it had been called. The
// interpreter then goes on after the call, until the next unit where machine code can be entered.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "ir/bytecode/image.h"
#include "vm/native/lir.h"

namespace vm::native {

struct Callee {
  const Function* function = nullptr;
  const ir::Unit* units = nullptr;
};

// May the POU be a callee's body at all? No loops, no calls, nothing that the interpreter does for
// it.
bool is_small(const ir::LinkedPou& pou, std::span<const ir::Unit> code);

// Returns the numbers of the POUs whose bodies are in `function` now.
std::vector<uint32_t> inline_calls(Function& function,
                                   const std::function<Callee(uint32_t)>& callee_of);

}  // namespace vm::native
