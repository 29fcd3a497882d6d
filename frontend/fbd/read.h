// Function block diagram as text: a list of boxes and of what they are connected to.
//
//   FBD
//     (* holds the room at 20 degrees *)
//     delay : TON(IN := [/ Door ], PT := T#30s);   // the box of the instance `delay`
//     WIRE cold := LT(Temperature, 20.0);          // the box of a function; `cold` is its result
//     WIRE both := AND(delay.Q, cold);
//     Heater := both;
//     Lamp S= both;
//     JMP Quiet IF both;
//     RETURN IF Manual;
//   Quiet:                                         // what follows is the next network
//     Beep := FALSE;
//   END_FBD
//
// Boxes are executed as they stand. An operand is a wire, an output of a box after a `.`
// (delay.Q, cold.ENO), or an expression, in which wires are values as variables are
// (network/expressions.h). `NOT x`, `[/ x]`, `[P x]`, `[N x]` are
// pins that are negated or see edges. EN and ENO are pins as others: while EN is FALSE,
// variables that a box writes stay as they are. The output of a function block may be used above
// its box: then it is that of the last scan. A wire may not: it is kept nowhere. Wires are known
// in their network, and not outside.
#pragma once

#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace frontend::fbd {

// As ladder::read; of what stands between FBD and END_FBD. Messages: E1060..E1063.
network::Body read(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics);

}  // namespace frontend::fbd
