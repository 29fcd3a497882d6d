// Assignments, chained and inside of expressions: `a := b := 3`, `S=`, `R=`, `REF=`, `?=`.
#include "frontend/parse/parser.h"

namespace frontend {

// The assignment operator here. S=, R= and REF= are two tokens, side by side.
std::optional<AssignOp> Parser::assign_op_here() const {
  if (kind() == TokenKind::kAssign) return AssignOp::kAssign;
  if (kind() == TokenKind::kAttempt) return AssignOp::kAttempt;
  if (!is_name(kind()) || next_kind() != TokenKind::kEqual) return std::nullopt;
  if (current_->begin + current_->length != peek(1).begin) return std::nullopt;
  if (is_word(*current_, "S")) return AssignOp::kSet;
  if (is_word(*current_, "R")) return AssignOp::kReset;
  if (is_word(*current_, "REF")) return AssignOp::kReference;
  return std::nullopt;
}

void Parser::take_assign_op() {
  bool pair = is_name(kind());
  take();
  if (pair) take();
}

void Parser::parse_assignment(ExprId target, AssignOp op, base::SourcePos begin) {
  take_assign_op();
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.assign = op;
  stmt.target = target;
  stmt.value = parse_assigned();
  stmt.span = span_from(begin);
  add_statement(stmt);
}

// What stands after an assignment operator: a value, or the rest of a chain.
ExprId Parser::parse_assigned() {
  ExprId left = parse_listed_value();
  auto op = assign_op_here();
  return op && !panic_ ? parse_assign_expression(left, *op) : left;
}

ExprId Parser::parse_assign_expression(ExprId target, AssignOp op) {
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  Expr expr;
  expr.kind = ExprKind::kAssign;
  expr.assign = op;
  expr.op = here();
  take_assign_op();
  expr.operand = target;
  expr.right = parse_assigned();
  expr.span = span_from(tree_[target].span.begin);
  return add_expression(expr);
}

// `(member := value, ...)` gives members where a value of a variable is expected;
// elsewhere, and in front of an operator, `(a := b)` is an assignment in parentheses.
ExprId Parser::parse_listed_value() {
  if (!at_member_list()) return parse_expression();
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  ExprId list = parse_struct_initializer();
  if (panic_ || tree_[list].list.count != 1 || !at_operator()) return list;
  Arg arg = tree_.args[tree_[list].list.first];
  Expr name;
  name.kind = ExprKind::kName;
  name.name = arg.name;
  name.span = arg.name.span;
  ExprId target = add_expression(name);
  Expr& assign = tree_.exprs[list.index];
  assign.kind = ExprKind::kAssign;
  assign.operand = target;
  assign.right = arg.value.valid() ? arg.value : target;
  assign.list = {};
  assign.parenthesised = true;
  return parse_operators(list, 0);
}

bool Parser::at_member_list() const {
  return kind() == TokenKind::kLeftParen && is_name(next_kind()) &&
         peek(2).kind == TokenKind::kAssign;
}

}  // namespace frontend
