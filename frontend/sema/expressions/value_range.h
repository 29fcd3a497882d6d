// Which values a whole number can have, as far as its expression tells: W0084 keeps quiet where an
// operation cannot leave its type.
#pragma once

#include "frontend/sema/constants/constant.h"
#include "frontend/sema/phase.h"

namespace frontend {

// Of an integer or a bit string. Constants, subranges, conversions and LIMIT, MAX, MIN, ABS are
// looked into; of anything else, the limits of the type.
Limits range_of(const Phase& phase, ExprId id);
// What an operator would give if its type were large enough.
bool may_leave_type(const Phase& phase, ExprId id);
// Can it only be 0 or above, if its type is large enough?
bool is_natural(const Phase& phase, ExprId id);

}  // namespace frontend
