// May a write to one place change what another place holds? Errs on the safe side.
// Areas never overlap: the globals, an instance's own variables, and the instances
// it contains are different memory; what a reference points to may be any of it.
#pragma once

#include "ir/lower/values.h"
#include "ir/program/ir.h"

namespace ir::codegen {

bool may_alias(const Place& a, const Place& b, const Values& values);
// May a called POU read or write it? Only locals whose address nobody took are private.
bool calls_may_change(const Place& place, const Values& values);
// A fixed offset from a fixed root: reading it needs no instruction and cannot trap.
bool is_static(const Place& place, const Values& values);

}  // namespace ir::codegen
