// Between parsing and sema: where hierarchical addresses are. The fields of `%IW2.5.7.1` name a
// bus, a rack, a module and a channel, from left to right (IEC 61131-3, Table 16), and what they
// stand for is the plant's affair: the project says at which byte of the process image the
// channels of a module begin, with attributes in front of CONFIGURATION or another declaration:
//
//     {attribute 'address_map' := '%I2.5.7 = %IB100'}
//
// Channels are counted in units of the address's size: `%IW2.5.7.1` is then `%IB102`, one WORD;
// bits are `%IX2.5.7.12` or, with their byte, `%IX2.5.7.1.4`. The longest match counts. A later
// pass sees flat addresses only, whose `levels` are empty; the others were reported.
#pragma once

#include "base/diagnostics.h"
#include "frontend/parse/tree.h"

namespace frontend {

void map_addresses(Tree& tree, base::Diagnostics& diagnostics);

}  // namespace frontend
