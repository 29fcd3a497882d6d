#include "vm/exec/handle.h"
#include "vm/exec/semantics_memory.h"

namespace vm {

STC_INSTANTIATE_GROUP(kMemoryHandlers);

}  // namespace vm
