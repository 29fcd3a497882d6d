// Initial values in a form that depends on nothing but what they say: members by name, no numbers
// of a table.
#pragma once

#include "base/bytes.h"
#include "ir/types/constants.h"
#include "ir/types/types.h"

namespace ir {

// Appends the value of a `type`. What it leaves to the type is the type's, so it is left out.
void write_canonical(base::ByteWriter& out, const TypeTable& types, const ConstTable& constants,
                     TypeId type, ConstId value);

}  // namespace ir
