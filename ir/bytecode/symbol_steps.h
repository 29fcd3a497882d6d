// From a variable to what is inside of it. The child of an instance is found through the ID in the
// slot's initial data, which never changes while the slot lives, so no search over the instance
// table is needed.
#pragma once

#include "ir/bytecode/symbols.h"

namespace ir {

// Steps into the instance whose ID is in the slot at symbol.data; false when there is none.
bool enter(const Image& image, Symbol& symbol);
// Member `number` of `owner`.
Symbol member_of(const Image& image, const Symbol& owner, size_t number);

}  // namespace ir
