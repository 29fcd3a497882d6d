// How much of the process image a located variable takes: `AT %IX2.0`, `AT %QW4 : ARRAY[0..9] OF
// INT`, `AT %IB0 : Inputs`. There a value lies as a first version of the program lays it out
// (natural_layout.h), whatever holes changes have left in the variable: what devices exchange does
// not depend on a program's history.
#pragma once

#include "ir/types/layout.h"

namespace ir {

// May devices read and write it? Numbers, bits and times, and arrays and structures of them: a
// string could arrive without its end, a reference could name anything.
bool is_locatable(const TypeTable& types, TypeId type);

// BOOLs that take one bit each after `address`: a BOOL alone, or all elements of an array of BOOL
// at a bit address. 0: the variable takes whole bytes, one for a BOOL.
uint64_t located_bools(const TypeTable& types, TypeId type, const DirectAddress& address);

// In bits, from `address` on. `natural` is of natural_layouts().
uint64_t located_bits(const TypeTable& types, const Layouts& natural, TypeId type,
                      const DirectAddress& address);

}  // namespace ir
