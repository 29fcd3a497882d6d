#include "vm/exec/handle.h"
#include "vm/exec/semantics_compare.h"

namespace vm {

STC_INSTANTIATE_GROUP(kCompareHandlers);

}  // namespace vm
