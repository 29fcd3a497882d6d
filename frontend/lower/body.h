// Lowers bodies: checks every statement against the types that sema knows, and writes IR by the
// contract of ir/program/ir.h. The work is done by the phases of this folder (body_phase.h), which
// share the body that they write (lowering.h).
#pragma once

#include "frontend/sema/sema.h"

namespace frontend {

// Lowers the body of a POU that has one.
void write_body(Sema& sema, uint32_t pou);

}  // namespace frontend
