// Values that people give to outputs.
#pragma once

#include "base/bytes.h"
#include "base/result.h"
#include "ir/bytecode/symbols.h"

namespace vm {

// kBadValue: devices cannot be given it. Others than outputs take any value.
base::Status fits_output(const ir::Image& image, const ir::Symbol& symbol,
                         const base::Bytes& bytes);

}  // namespace vm
