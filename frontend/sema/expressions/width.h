// Width of intermediate results (docs/LANGUAGE.md). Dialects codesys and twincat compute integers
// and bit strings below 32 bits as DINT and cut them where they are stored, passed or converted;
// iec computes them in their own type.
#pragma once

#include <optional>
#include <vector>

#include "frontend/sema/sema.h"

namespace frontend {

class Phase;

// An integer or a bit string below 32 bits?
bool is_small(const Sema& sema, const Note& note);
// One below 64 bits? An operation on it could have been done in a longer type.
bool has_wider(const Sema& sema, const Note& note);
// The width of an operator's result, whose type is the note's. `can_grow`: it may leave that type.
Width width_of(const Sema& sema, const Note& note, bool can_grow);
// The type that code computes the expression in.
ir::TypeId computed_type(const Sema& sema, const Note& note);
// A quotient that fits the type of its operands is computed in it: every rest, and what is not the
// most negative number divided by -1.
Note quotient_width(const Sema& sema, Note note, const Expr& expr, const Note& left,
                    const Note& right);
// The width of a standard function's result. Functions that CODESYS calls operators (ADD, MAX, SEL,
// ABS, ...) compute as operators do; arguments of all others are passed, which cuts them.
Width standard_width(const Phase& phase, const stdlib::FunctionRow& row,
                     const std::vector<ExprId>& args, const Note& note, bool typed);
// What operands that have a type in common are compared in: DINT where one of them is wide.
ir::TypeId compared_type(const Phase& phase, ir::TypeId common,
                         const std::vector<ExprId>& operands);
// codesys, twincat: the same of operators of comparison, where a literal that does not fit
// `compared` has a type of its own, DINT or a longer one.
ir::TypeId compared_with_literals(const Phase& phase, ir::TypeId compared,
                                  const std::vector<ExprId>& operands);
// Was one of them made by an operator that computes it as DINT?
bool has_wide(const Phase& phase, const std::vector<ExprId>& operands);
// A literal that does not fit the type of the other operands gives the operation the smallest type
// that holds both: DINT or a longer one where it is `arithmetic`, which grows. `note`: as unified.
Note widened_by(const Phase& phase, Note note, ExprId operand, bool arithmetic);
// Of a binary operator whose note was `unified` before literals widened it: can its context choose
// between DINT and UDINT, LINT and ULINT? `u * 70000` of a UINT.
bool has_any_sign(const Phase& phase, const Expr& expr, ir::TypeId unified, const Note& note);
// The unsigned type of the same size, where such a note stands in the context of `target`;
// else its own type.
ir::TypeId signed_by_context(const ir::TypeTable& types, const Note& note, ir::TypeId target);
// `a[i + 1]`: is an index that wraps in its own type out of bounds then? A wide index is out of
// bounds in the same cases, so the small one will do. The text of the trap has the wrapped number.
bool wraps_outside(const Sema& sema, const Note& note, const Expr& index, const Note& left,
                   Limits bounds);
// The low bits that `target` has room for, where `value` is an intermediate result that is stored
// there; nothing where the usual rules apply.
std::optional<uint64_t> cut_to(const Sema& sema, const Constant& value, const Note& note,
                               ir::TypeId target);

}  // namespace frontend
