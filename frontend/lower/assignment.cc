// Assignments. The indices of the left side are evaluated first, then the value.
#include "frontend/lower/body.h"

namespace frontend {

void Body::assign(const Stmt& stmt) {
  const Expr& right = tree_[stmt.value];
  bool list = right.kind == ExprKind::kArrayInit || right.kind == ExprKind::kStructInit;
  auto to = target(stmt.target);
  if (!to) {
    if (!list) sema_.infer(stmt.value);  // its errors count too
    return;
  }
  if (!types().is_scalar(to->type)) {
    assign_aggregate(*to, stmt.value);
    return;
  }
  ir::ValueId from = value(stmt.value, to->type);
  set_line(stmt.span);
  store(*to, from);
}

void Body::assign_aggregate(const Target& to, ExprId value) {
  const Expr& expr = tree_[value];
  if (types().is_instance(to.type)) {
    sema_.error(DiagnosticCode::kNotAssignable, expr.span,
                "instances of `" + sema_.type_text(to.type) + "` cannot be assigned",
                "copy the variables that matter one by one");
    return;
  }
  if (expr.kind == ExprKind::kArrayInit || expr.kind == ExprKind::kStructInit) {
    ir::ConstId init = sema_.initial_value(value, to.type);
    if (init.valid()) build_.init(to.place, init);
    return;
  }
  const Note& note = sema_.infer(value);
  if (!note.type.valid()) return;
  bool strings = is_string(types(), to.type) && types()[note.type].kind == types()[to.type].kind;
  if (!strings && note.type != to.type) {
    sema_.error(
        DiagnosticCode::kTypeMismatch, expr.span,
        "`" + sema_.type_text(note.type) + "` does not go with `" + sema_.type_text(to.type) + "`");
    return;
  }
  if (strings && note.constant) {  // says so when the text is too long
    auto text = sema_.fold(value, to.type);
    if (!text || !sema_.fit_text(*text, to.type, expr.span)) return;
  }
  ir::Place from = place(value);
  build_.copy(to.place, from);
}

}  // namespace frontend
