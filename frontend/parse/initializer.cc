// Initial values: expressions, `[1, 2, 3(7)]`, `(member := value)`, and the older
// array form without brackets, `:= 1, 2, 3(7)`.
#include "frontend/parse/parser.h"

namespace frontend {

ExprId Parser::parse_initializer() {
  base::SourcePos begin = here();
  bool repeat = kind() == TokenKind::kInteger && next_kind() == TokenKind::kLeftParen;
  ExprId first = parse_initializer_value();
  if (panic_ || (!repeat && kind() != TokenKind::kComma)) return first;
  return parse_open_array_initializer(first, begin);
}

ExprId Parser::parse_initializer_value() {
  if (kind() == TokenKind::kInteger && next_kind() == TokenKind::kLeftParen) return parse_repeat();
  return parse_listed_value();
}

ExprId Parser::parse_array_initializer() {
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  const Token open = take();
  size_t mark = expr_stack_.size();
  if (kind() != TokenKind::kRightBracket) {
    do {
      expr_stack_.push_back(parse_initializer_value());
    } while (!panic_ && accept(TokenKind::kComma));
  }
  close_bracket(TokenKind::kRightBracket, open);
  Expr expr;
  expr.kind = ExprKind::kArrayInit;
  expr.list = move_tail(expr_stack_, mark, tree_.expr_lists);
  expr.span = span_from({open.begin});
  return add_expression(expr);
}

ExprId Parser::parse_open_array_initializer(ExprId first, base::SourcePos begin) {
  size_t mark = expr_stack_.size();
  expr_stack_.push_back(first);
  while (!panic_ && accept(TokenKind::kComma)) expr_stack_.push_back(parse_initializer_value());
  Expr expr;
  expr.kind = ExprKind::kArrayInit;
  expr.list = move_tail(expr_stack_, mark, tree_.expr_lists);
  expr.span = span_from(begin);
  return add_expression(expr);
}

// `3(7)`, `2(1, 2, 3)`, `4()`
ExprId Parser::parse_repeat() {
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  Expr expr;
  expr.kind = ExprKind::kRepeat;
  base::SourcePos begin = here();
  expr.operand = parse_literal({}, begin, false);
  const Token open = take();
  size_t mark = expr_stack_.size();
  if (kind() != TokenKind::kRightParen) {
    do {
      expr_stack_.push_back(parse_initializer_value());
    } while (!panic_ && accept(TokenKind::kComma));
  }
  close_bracket(TokenKind::kRightParen, open);
  expr.list = move_tail(expr_stack_, mark, tree_.expr_lists);
  expr.span = span_from(begin);
  return add_expression(expr);
}

ExprId Parser::parse_struct_initializer() {
  Expr expr;
  expr.kind = ExprKind::kStructInit;
  base::SourcePos begin = here();
  expr.list = parse_arguments();
  expr.span = span_from(begin);
  return add_expression(expr);
}

}  // namespace frontend
