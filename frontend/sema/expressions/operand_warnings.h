// What operators may do, but is hardly meant: W0002, W0006, W0016, W0084; and E3012.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

// AND or OR whose right operand can trap, and does not only what the left one has done before.
void check_right_operand(const Phase& phase, const Expr& expr);
// The divisor is constant. `whole`: 0 traps. A literal is an error then (E3012).
void check_divisor(const Phase& phase, ExprId divisor, bool whole);
void check_real_equality(const Phase& phase, const Expr& expr);
// One side is a literal that no value of `type` reaches, which the other side has.
void warn_of_decided(const Phase& phase, BinaryOp op, ExprId left, ExprId right, ir::TypeId type);
// Is `target` a number that has values which `own`, an integer or a bit string, has not?
bool is_wider(const ir::TypeTable& types, ir::TypeId target, ir::TypeId own);
// Dialect iec: an operand that was cut to its type before it is `used`: "compared", "widened".
// Behind a function that selects, as MAX, what it selects from.
void check_wrapped(const Phase& phase, ExprId operand, std::string_view used);

}  // namespace frontend
