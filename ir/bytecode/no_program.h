// The program that a controller holds when it has none: the globals without a member, no POU, no
// task. It is what the linker makes of nothing, with an area of the least size. Any program is an
// online change of it, and is linked as a first version is.
#pragma once

#include "ir/bytecode/verify.h"

namespace ir {

// Always the same bytes.
const VerifiedImage& no_program();

// Without a task there is nothing that could run.
bool is_no_program(const Image& image);

}  // namespace ir
