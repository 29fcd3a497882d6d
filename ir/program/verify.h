// Checks every rule of ir.h: typing of operands and places, dominance, terminators,
// the call discipline. Run after lowering and after every pass in debug builds and tests.
#pragma once

#include "base/result.h"
#include "ir/program/ir.h"

namespace ir {

base::Status verify(const Program& program);
base::Status verify(const Program& program, const Pou& pou);

}  // namespace ir
