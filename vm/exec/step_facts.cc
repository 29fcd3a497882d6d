// Which opcodes are steps, from what their Semantics are.
#include "vm/exec/fusion.h"
#include "vm/exec/semantics_arithmetic.h"
#include "vm/exec/semantics_compare.h"
#include "vm/exec/semantics_control.h"
#include "vm/exec/semantics_convert.h"
#include "vm/exec/semantics_logic.h"
#include "vm/exec/semantics_memory.h"

namespace vm {
namespace {

template <ir::Opcode op>
constexpr StepFacts facts_of() {
  if constexpr (requires { sizeof(Semantics<op>); }) {
    return {Semantics<op>::kReads >= 0, requires {Semantics<op>::kStores;
  }
};
}  // namespace
else {
  return {};
}
}  // namespace vm

}  // namespace

constinit const std::array<StepFacts, ir::kOpcodeCount> kStepFacts = {{
#define OP(name, a, b, c, x, y, flags, meaning) facts_of<ir::Opcode::name>(),
#include "ir/bytecode/opcodes.def"
#undef OP
}};

}  // namespace vm
