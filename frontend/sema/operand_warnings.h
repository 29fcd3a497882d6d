// What operators may do, but is hardly meant: W0002, W0006, W0016, W0084.
#pragma once

#include "frontend/sema/sema.h"

namespace frontend {

// AND or OR whose right operand can trap, and does not only what the left one has done before.
void check_right_operand(Sema& sema, const Expr& expr);
void check_divisor(Sema& sema, ExprId divisor);  // is known
void check_real_equality(Sema& sema, const Expr& expr);
// Dialect iec: an operand that was cut to its type before it is `used`: "compared", "widened".
void check_wrapped(Sema& sema, ExprId operand, std::string_view used);

}  // namespace frontend
