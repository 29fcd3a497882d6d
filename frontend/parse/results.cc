// Values without a variable, which instruction lists and diagrams keep (kResult), and NOT of them.
#include "frontend/parse/parser.h"

namespace frontend {

ExprId Parser::add_result(base::SourceSpan span, bool at_label) {
  Expr expr;
  expr.kind = ExprKind::kResult;
  expr.number = static_cast<uint32_t>(tree_.results.size());
  expr.span = span;
  tree_.results.push_back({{}, at_label});
  return add_expression(expr);
}

void Parser::set_values(ExprId result, const std::vector<ExprId>& values) {
  tree_.results[tree_[result].number].values = {static_cast<uint32_t>(tree_.expr_lists.size()),
                                                static_cast<uint32_t>(values.size())};
  tree_.expr_lists.insert(tree_.expr_lists.end(), values.begin(), values.end());
}

// Another place where the result stands; `operand` is the first one.
ExprId Parser::copy_of(ExprId result, base::SourceSpan span) {
  Expr copy = tree_[result];
  copy.span = span;
  if (copy.kind == ExprKind::kResult && !copy.operand.valid()) copy.operand = result;
  return add_expression(copy);
}

ExprId Parser::negated(ExprId operand, base::SourceSpan span) {
  Expr expr;
  expr.kind = ExprKind::kUnary;
  expr.unary = UnaryOp::kNot;
  expr.operand = operand;
  expr.op = span.begin;
  expr.span = span;
  return add_expression(expr);
}

}  // namespace frontend
