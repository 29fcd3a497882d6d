#include "tools/stvm/trap_text.h"

namespace stvm {

std::string trap_text(const vm::TrapRow& trap) {
  std::string out = "cycle " + std::to_string(trap.cycle) + ", task " + trap.task + ": ";
  if (!trap.text.file.empty()) {
    out += trap.text.file + ":" + std::to_string(trap.text.line) + " ";
  }
  return out + "(" + trap.text.pou + "): " + trap.text.text;
}

std::string trap_text(const vm::TrapRecord& trap) {
  return trap_text(vm::TrapRow{trap.cycle, trap.task, trap.text});
}

}  // namespace stvm
