// Which outputs are a task's own, as far as the image tells: variables of the instances of its
// programs, and globals that its code writes by name. What it writes through references is learned
// from its scans (Scheduler).
#pragma once

#include "vm/runtime/task_tables.h"

namespace vm {

// Fills TaskSlot::own_outputs of all tasks.
void mark_own_outputs(TaskTables& tables);

}  // namespace vm
