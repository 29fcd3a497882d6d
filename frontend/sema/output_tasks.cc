// Exactly one task writes each byte of the output image: otherwise the order of two
// tasks would decide what the plant sees (reliability.md, verifier rule on I/O).
#include "frontend/sema/sema.h"
#include "ir/types/location.h"
#include "ir/types/natural_layout.h"

namespace frontend {

void Sema::check_output_tasks() {
  if (program.tasks.size() < 2 || diagnostics_.has_errors()) return;
  const ir::Layouts natural = ir::natural_layouts(program.types);
  std::unordered_map<uint32_t, uint32_t> owner;  // output byte -> task
  for (const ir::ProgramInstance& instance : program.instances) {
    if (instance.task == ir::kNoTask) continue;
    check_instance_outputs(instance, natural, owner);
  }
}

// Everything that the program's body can reach through calls.
void Sema::check_instance_outputs(const ir::ProgramInstance& instance, const ir::Layouts& natural,
                                  std::unordered_map<uint32_t, uint32_t>& owner) {
  auto start = pou_by_type_.find(instance.type);
  if (start == pou_by_type_.end()) return;
  std::vector<bool> seen(pous.size());
  std::vector<uint32_t> work{start->second};
  seen[start->second] = true;
  while (!work.empty()) {
    const PouInfo& pou = pous[work.back()];
    work.pop_back();
    for (uint32_t callee : pou.callees) {
      if (seen[callee]) continue;
      seen[callee] = true;
      work.push_back(callee);
    }
    for (const OutputWrite& write : pou.writes) {
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
