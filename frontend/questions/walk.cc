#include "frontend/questions/walk.h"

namespace frontend::questions {

void Walker::statements(Range32 list) {
  for (uint32_t i = 0; i < list.count; ++i) statement(tree_[tree_.stmt_lists[list.first + i]]);
}

void Walker::statement(const Stmt& stmt) {
  const bool writes = stmt.kind == StmtKind::kAssign || stmt.kind == StmtKind::kFor;
  expression(stmt.target, writes ? Use::kWritten : Use::kRead);
  expression(stmt.value);
  expression(stmt.from);
  expression(stmt.to);
  expression(stmt.by);
  for (uint32_t i = 0; i < stmt.arms.count; ++i) {
    if (stmt.kind == StmtKind::kCase) {
      const CaseArm& arm = tree_.cases[stmt.arms.first + i];
      for (uint32_t label = 0; label < arm.labels.count; ++label) {
        expression(tree_.labels[arm.labels.first + label].low);
        expression(tree_.labels[arm.labels.first + label].high);
      }
      statements(arm.body);
    } else {
      const Branch& arm = tree_.branches[stmt.arms.first + i];
      expression(arm.condition);
      statements(arm.body);
    }
  }
  statements(stmt.body);
  statements(stmt.else_body);
}

void Walker::chart(const Chart& chart) {
  for (const ChartStep& step : chart.steps) {
    for (const ActionUse& use : step.uses) {
      expression(use.target, Use::kWritten);
      expression(use.time);
      for (const ExprId indicator : use.indicators) expression(indicator);
    }
  }
  for (const ChartTransition& transition : chart.transitions) expression(transition.condition);
  for (const ChartAction& action : chart.actions) statements(action.body);
}

void Walker::expressions(Range32 list) {
  for (uint32_t i = 0; i < list.count; ++i) expression(tree_.expr_lists[list.first + i]);
}

void Walker::arguments(Range32 list) {
  for (uint32_t i = 0; i < list.count; ++i) {
    const Arg& arg = tree_.args[list.first + i];
    expression(arg.value, arg.output ? Use::kWritten : Use::kRead);
  }
}

Use Walker::use_by(const Expr& call, uint32_t argument) {
  return tree_.args[call.list.first + argument].output ? Use::kWritten : Use::kRead;
}

void Walker::arguments(const Expr& call) {
  for (uint32_t i = 0; i < call.list.count; ++i) {
    expression(tree_.args[call.list.first + i].value, use_by(call, i));
  }
}

// Recursion is as deep as the parser lets expressions be (Expr::height).
void Walker::expression(ExprId id, Use use) {
  if (!id.valid()) return;
  const Expr& expr = tree_[id];
  visit(expr, id, use);
  switch (expr.kind) {
    case ExprKind::kCall:
      expression(expr.operand);
      arguments(expr);
      return;
    case ExprKind::kStructInit:
      expression(expr.operand);
      arguments(expr.list);
      return;
    case ExprKind::kMember:
    case ExprKind::kIndex:
    case ExprKind::kBit:
      expression(expr.operand, is_part(expr) ? use : Use::kRead);
      if (expr.kind == ExprKind::kIndex) expressions(expr.list);
      return;
    case ExprKind::kArrayInit:
    case ExprKind::kRepeat:
      expression(expr.operand);
      expressions(expr.list);
      return;
    case ExprKind::kAssign:
      expression(expr.operand, Use::kWritten);
      expression(expr.right);
      return;
    case ExprKind::kType:
      spec(expr.spec());
      return;
    case ExprKind::kResult:
      return;  // of values that stand where they are assigned
    default:
      expression(expr.operand);
      expression(expr.right);
  }
}

void Walker::spec(SpecId id) {
  if (!id.valid()) return;
  const Spec& type = tree_[id];
  visit(type, id);
  expression(type.length);
  expression(type.low);
  expression(type.high);
  for (const DimSpec& dim : type.dims) {
    expression(dim.low);
    expression(dim.high);
  }
  arguments(type.args);
  expressions(type.element_args);
  spec(type.element);
  for (const VarDecl& field : type.fields) {
    spec(field.spec);
    expression(field.init);
  }
  for (const Enumerator& enumerator : type.enumerators) expression(enumerator.value);
}

}  // namespace frontend::questions
