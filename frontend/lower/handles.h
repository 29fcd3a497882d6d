// What becomes of handles in expressions (docs/adr/0005-references-are-handles.md): compared,
// moved, and taken as pointers to something else.
#pragma once

#include "frontend/lower/builder.h"

namespace frontend {

// A pointer and by how many bytes it is to be moved.
struct MovedPointer {
  ir::ValueId handle;
  ir::ValueId bytes;             // i64; invalid: none
  ir::ValueId has_address;       // BOOL: one of the numbers was an address; invalid: none can be
  bool unsigned_number = false;  // a variable of 32 bits was subtracted, as if it were an address
};

// What a handle is compared by: the byte that it names. A pointer that arithmetic moved to one past
// the end is equal to one that was made from the number of the same address. When `ordered`, an
// offset before the first byte of an area is negative.
ir::ValueId compared_place(Builder& build, ir::ValueId handle, bool ordered);

// Is a pointer to an instance taken as one to something else?
bool is_instance_view(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to);
// Then it may go wherever the instance has variables, and not in the first one only.
ir::ValueId whole_instance(Builder& build, ir::ValueId handle);

}  // namespace frontend
