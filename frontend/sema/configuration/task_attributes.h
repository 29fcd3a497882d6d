// Attributes in front of TASK: its policies (ir/program/task_policy.h) and its watchdog time. In
// front of RESOURCE, or of its CONFIGURATION: its schedule.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

inline constexpr int64_t kDefaultPeriodNs = 10'000'000;  // of a task that says none

// Reports values that are none (E5009); attributes with other names are somebody else's.
void apply_task_attributes(const Phase& phase, const TaskDecl& decl, ir::Task& task);

void apply_schedule(const Phase& phase, const Name& owner, Range32 attributes);

// What all periods are multiples of is the control cycle; a period that fits no other would make it
// so short that nothing could keep up with it (E5002). `decls` are the newest of Program::tasks.
void check_base_cycle(const Phase& phase, const std::vector<TaskDecl>& decls);

}  // namespace frontend
