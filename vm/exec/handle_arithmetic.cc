#include "vm/exec/handle.h"
#include "vm/exec/semantics_arithmetic.h"

namespace vm {

STC_INSTANTIATE_GROUP(kArithmeticHandlers);

}  // namespace vm
