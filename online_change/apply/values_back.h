// Values that an edit took away or converted, for a change that takes this edit out from below
// later ones (X4, change case 77): the variables come back with what they held, as they do by undo.
#pragma once

#include <vector>

#include "ir/bytecode/image.h"
#include "online_change/apply/transfer.h"

namespace online_change {

// The edit that is taken out.
struct TakenEdit {
  const Transfer& forward;
  const Transfer& way_back;
  const ir::Image& before;  // what it was made on
  const ir::Image& after;
  std::vector<const ir::Image*> later;  // what later edits made; the last one runs
};

// In `plan`, a change from what runs to `next`:
// - what is initialised under a path that the edit took away gets the value that its way back
//   remembers, where it has the same type. References begin as initialised: what they led to may
//   have moved since.
// - what the edit converted gets its value from before the edit, where it is still what the edit
//   made of it when the switch comes, and no later edit has given it another type or name. What
//   somebody has written since is converted from what it is then, with a loss where that loses.
// The rows of the plan say so. Returns how many values may come back.
uint64_t put_values_back(Plan& plan, const ir::Image& next, const TakenEdit& edit);

}  // namespace online_change
