// Exactly one task writes each byte of the output image: otherwise the order of two
// tasks would decide what the plant sees (V14).
#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/sema.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"

namespace frontend {

void CommonUses::check_output_tasks() {
  if (sema_.program.tasks.size() < 2 || sema_.report.has_errors()) return;
  const ir::Layouts natural = ir::natural_layouts(sema_.program.types);
  std::unordered_map<uint32_t, uint32_t> owner;  // output byte -> task
  for (const ir::ProgramInstance& instance : sema_.program.instances) {
    if (instance.task == ir::kNoTask) continue;
    check_instance_outputs(instance, natural, owner);
  }
}

// Everything that the program's body can reach through calls.
void CommonUses::check_instance_outputs(const ir::ProgramInstance& instance,
                                        const ir::Layouts& natural,
                                        std::unordered_map<uint32_t, uint32_t>& owner) {
  const ir::Program& program = sema_.program;
  for (uint32_t pou : reached_from({instance.type})) {
    for (const OutputWrite& write : sema_.declared.pous[pou].writes) {
      uint64_t bits = ir::located_bits(program.types, natural, write.type, write.address);
      auto last = static_cast<uint32_t>((write.address.bit_offset + bits - 1) / 8);
      for (uint32_t byte = write.address.bit_offset / 8; byte <= last; ++byte) {
        uint32_t first_task = owner.emplace(byte, instance.task).first->second;
        if (first_task == instance.task) continue;
        error(DiagnosticCode::kOutputTwoTasks, write.span,
              "output byte %QB" + std::to_string(byte) + " is written by task `" +
                  program.tasks[first_task].name + "` and by task `" +
                  program.tasks[instance.task].name + "`",
              "let one task write it; the other sets a global variable that the first reads");
        return;
      }
    }
  }
}

}  // namespace frontend
