#include "vm/exec/handle.h"
#include "vm/exec/semantics_convert.h"

namespace vm {

STC_INSTANTIATE_GROUP(kConvertHandlers);

}  // namespace vm
