// Values that an edit took away, for a change that takes this edit out from below later ones (X4,
// change case 77): the variables come back with what they held, as they do by undo.
#pragma once

#include "ir/bytecode/image.h"
#include "online_change/apply/transfer.h"

namespace online_change {

// In `plan`, a change to `next`, what is initialised under a path that the edit took away gets the
// value that its way back remembers, where it has the same type. `before` is what the edit was made
// on. References begin as initialised: what they led to may have moved since. Returns how many
// values come back.
uint64_t put_values_back(Plan& plan, const ir::Image& next, const Transfer& way_back,
                         const ir::Image& before);

}  // namespace online_change
