#include "vm/exec/handle.h"
#include "vm/exec/semantics_logic.h"

namespace vm {

STC_INSTANTIATE_GROUP(kLogicHandlers);

}  // namespace vm
