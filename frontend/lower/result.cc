// The current result of an instruction list. Within straight code it is a value, at a label a
// local that every way there assigns.
#include "frontend/lower/assignments.h"
#include "frontend/lower/current_results.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {

// In the order of the source each result depends on what is known already only.
void CurrentResults::infer_results(Range32 list) {
  for (uint32_t i = 0; i < list.count; ++i) {
    const Stmt& stmt = tree_[tree_.stmt_lists[list.first + i]];
    if (!stmt.instruction) continue;
    bool keeps = stmt.kind == StmtKind::kAssign && tree_[stmt.target].kind == ExprKind::kResult;
    if (keeps) infer(stmt.value);
    if (stmt.kind == StmtKind::kIf) infer_results(tree_.branches[stmt.arms.first].body);
  }
}

void CurrentResults::keep_result(const Stmt& stmt) {
  if (!ask<Expressions>().check_result(stmt)) return;
  const Note& note = infer(stmt.target);
  const ir::TypeId type = note.type.valid() ? computed_type(sema_, note) : note.type;
  uint32_t number = tree_[stmt.target].number;
  bool single = !tree_.results[number].at_label && type.valid() && types().is_scalar(type);
  if (!single) {
    ask<Assignments>().assign_value(stmt.target, stmt.value, stmt.span);
  } else {
    body_.result_values.emplace(number, Typed{value(stmt.value, type), type});
  }
}

ir::ValueId CurrentResults::emit_result(ExprId id) {
  auto found = body_.result_values.find(tree_[id].number);
  if (found != body_.result_values.end()) return found->second.value;
  ir::Place from = place(id);
  return build_.load(from, scalar(from.type));
}

// The result is in the same local wherever it is used.
ir::Place CurrentResults::result_place(const Expr& expr, ir::TypeId type) {
  auto found = body_.result_places.find(expr.number);
  if (found != body_.result_places.end()) return found->second;
  ir::Place local = temporary_place(type);
  if (auto value = body_.result_values.find(expr.number); value != body_.result_values.end()) {
    const ir::ValueId kept =
        code_.machine_convert(value->second.value, scalar(value->second.type), scalar(type));
    build_.store(local, scalar(type), kept);
  } else {
    body_.result_places.emplace(expr.number, local);
  }
  return local;
}

}  // namespace frontend
