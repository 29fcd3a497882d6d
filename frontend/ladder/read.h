// Ladder as text -> networks. The text between LADDER and END_LADDER is a drawing: where a
// character stands counts, by column. Comments stand in rows of their own, in front of a rung.
//
//   LADDER
//     (* seal-in *)
//     |--[ Start ]--+--[/ Stop ]----------( Run )--|
//     |--[ Run ]----+
//     Again:
//     |--[P Count ]--[ CTU1: CTU  CU:=_, R:=Reset, PV:=10, Q=>Full ]--(S Lamp )--|
//     |--[ Level > 10 ]--[ Total := Total + Level ]--( JMP Again )--|
//   END_LADDER
//
// A row {network 'title' disabled} in front of a rung: network/head.h.
//
// Wires: `-` goes from side to side; `+` joins what touches it on all four sides; `|` goes up and
// down between `+`. The first `|` of the drawing is the left rail: every `|` in its column is. A
// `|` that ends a row after a wire or an element is the right rail, which may be left out. A rung
// is what is connected; its rows are neighbours. Elements:
//
//   [ a ]  [/ a ]  [P a ]  [N a ]       contact of any BOOL expression: plain, negated, edges
//   ( a )  (/ a )  (S a )  (R a )  (P a )  (N a )       coil of a variable; power goes on
//   ( JMP label )  ( RETURN )           only when power arrives
//   [ inst: TYPE  IN:=_, PT:=t, ET=>e ] function block
//   [ v := F(a, b) ]  [ v := a + b ]    done when power arrives: EN; power goes on by ENO
//   [ F(EN:=_, a, =>v) ]  [ F(a, _) ]   function; `=>v`: its result
//   [ v := F(a, rest=>r) ]              with VAR_OUTPUT: written in this order, the result last
//
// `_` is the pin where power arrives; without it that is EN, and IN of a timer. `=>_` is where it
// goes on; without it that is ENO for EN, Q of a function block, the result of a function.
// Arguments may be in parentheses or not. `NOT`, `[/ x]`, `[P x]`, `[N x]` as the value of an
// argument stand for a pin that is negated or sees edges.
#pragma once

#include "base/diagnostics.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/network/network.h"

namespace frontend::ladder {

// `text` is what stands between LADDER and END_LADDER and begins at `begin` of a SourceMap;
// invalid: it stands in none. Reports what is wrong (E1040..E1059) and gives what could be
// understood, well-formed as network.h demands. `declarations` tells which blocks EXTEND a timer;
// without them only TON, TOF and TP are timers, and power of others gets to EN by itself.
network::Body read(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics,
                   const DeclarationIndex* declarations = nullptr);

}  // namespace frontend::ladder
