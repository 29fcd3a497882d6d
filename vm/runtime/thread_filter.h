// What a served controller's threads may ask of Linux at all (seccomp), so that a defect that lets
// a message or a device run code of its own leads less far: no program is started, no other process
// is looked into or stopped, the control thread opens no connection, a device's thread makes no
// memory executable but that of a file. It cannot tell files apart, and threads share one memory:
// it is no wall between them. The table is system_calls.def.
//
// A call that is not permitted fails with EPERM, and the thread goes on: in a plant, outputs that
// stay under control are worth more than the end of a process that may only have met a newer
// library. Calls of Linux 5.1 and later fail with ENOSYS, so that libraries use older ones.
#pragma once

#include <cstdint>

#include "base/result.h"

namespace vm {

enum class ThreadKind : uint8_t { kAny, kControl, kDevice };

// Confines the calling thread and those that it begins from now on, for good; a second filter only
// takes away from the first. kNotPermitted: this kernel or processor has none.
base::Status confine_thread(ThreadKind kind);

}  // namespace vm
