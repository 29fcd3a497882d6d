#include "frontend/sema/phase.h"

#include "frontend/sema/expressions.h"
#include "frontend/sema/variables.h"

namespace frontend {

const Note& Phase::infer_anew(ExprId expr, Note& known) const {
  return ask<Expressions>().infer_now(expr, known);
}

const Variable& Phase::resolve_anew(VarId id) const { return ask<Variables>().resolve_now(id); }

}  // namespace frontend
