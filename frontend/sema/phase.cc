#include "frontend/sema/phase.h"

#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/expressions.h"

namespace frontend {

const Note& Phase::infer_anew(ExprId expr, Note& known) const {
  return ask<Expressions>().infer_now(expr, known);
}

const Variable& Phase::resolve_anew(VarId id) const { return ask<Variables>().resolve_now(id); }

}  // namespace frontend
