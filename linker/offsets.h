// Symbolic places of objects -> byte offsets.
#pragma once

#include <cstdint>

#include "ir/bytecode/object.h"
#include "ir/types/layout.h"

namespace linker {

// Offset from the place's root: from the start of the instance, the globals, the
// slot or the region.
uint64_t place_offset(const ir::ObjectPlace& place, const ir::Object& object,
                      const ir::Program& program, const ir::Layouts& layouts);
// Bytes between two neighbours when `dim` of the array is indexed.
uint64_t stride_of(const ir::TypeTable& types, const ir::Layouts& layouts, ir::TypeId array,
                   uint8_t dim);

}  // namespace linker
