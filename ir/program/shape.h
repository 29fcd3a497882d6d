// Questions about types that the verifier of the IR asks.
#pragma once

#include "ir/types/types.h"

namespace ir {

// Have both types the same bytes under any layout? Then an addr of one may stand for the other.
// Aliases and subranges of one elementary type are one shape.
bool same_shape(const TypeTable& types, TypeId a, TypeId b);
// What kCopy may copy: one shape, or two strings of one kind.
bool can_copy(const TypeTable& types, TypeId to, TypeId from);

}  // namespace ir
