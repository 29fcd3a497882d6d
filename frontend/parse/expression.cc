// Operators by precedence (IEC 61131-3 ed. 3, table 71): unary - + NOT bind
// tighter than **, and every binary operator groups from the left.
#include <algorithm>

#include "base/limits.h"
#include "frontend/parse/parser.h"

namespace frontend {

namespace {

struct Operator {
  uint8_t precedence = 0;  // 0: not a binary operator
  BinaryOp op = BinaryOp::kOr;
};

constexpr std::array<Operator, 256> make_operators() {
  std::array<Operator, 256> table{};
  auto set = [&table](TokenKind kind, uint8_t precedence, BinaryOp op) {
    table[static_cast<uint8_t>(kind)] = {precedence, op};
  };
  set(TokenKind::kOr, 1, BinaryOp::kOr);
  set(TokenKind::kOrElse, 1, BinaryOp::kOrElse);
  set(TokenKind::kXor, 2, BinaryOp::kXor);
  set(TokenKind::kAnd, 3, BinaryOp::kAnd);
  set(TokenKind::kAmpersand, 3, BinaryOp::kAnd);
  set(TokenKind::kAndThen, 3, BinaryOp::kAndThen);
  set(TokenKind::kEqual, 4, BinaryOp::kEq);
  set(TokenKind::kNotEqual, 4, BinaryOp::kNe);
  set(TokenKind::kLess, 5, BinaryOp::kLt);
  set(TokenKind::kLessEqual, 5, BinaryOp::kLe);
  set(TokenKind::kGreater, 5, BinaryOp::kGt);
  set(TokenKind::kGreaterEqual, 5, BinaryOp::kGe);
  set(TokenKind::kPlus, 6, BinaryOp::kAdd);
  set(TokenKind::kMinus, 6, BinaryOp::kSub);
  set(TokenKind::kStar, 7, BinaryOp::kMul);
  set(TokenKind::kSlash, 7, BinaryOp::kDiv);
  set(TokenKind::kMod, 7, BinaryOp::kMod);
  set(TokenKind::kPower, 8, BinaryOp::kPower);
  return table;
}
constexpr std::array<Operator, 256> kOperators = make_operators();

const Operator& operator_of(TokenKind kind) { return kOperators[static_cast<uint8_t>(kind)]; }

}  // namespace

ExprId Parser::parse_expression() {
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  return parse_binary(0);
}

ExprId Parser::parse_condition() {
  ExprId left = parse_expression();
  if (kind() != TokenKind::kAssign || panic_) return left;
  const Token op = take();
  note_only(Code::kAssignInExpression, op.span(), "`:=` assigns; a comparison is needed here",
            "write `=` to compare");
  ExprId right = parse_expression();
  return add_binary(left, op, right);
}

ExprId Parser::parse_binary(uint32_t above) { return parse_operators(parse_unary(), above); }

// The operators after `left` that bind more tightly than `above`.
ExprId Parser::parse_operators(ExprId left, uint32_t above) {
  while (operator_of(kind()).precedence > above) {
    const Token op = take();
    ExprId right = parse_binary(operator_of(op.kind).precedence);
    left = add_binary(left, op, right);
  }
  return left;
}

bool Parser::at_operator() const { return operator_of(kind()).precedence != 0; }

ExprId Parser::add_binary(ExprId left, const Token& op, ExprId right) {
  Expr expr;
  expr.kind = ExprKind::kBinary;
  expr.binary = op.kind == TokenKind::kAssign ? BinaryOp::kEq : operator_of(op.kind).op;
  expr.op = {op.begin};
  expr.span = {tree_[left].span.begin, tree_[right].span.end};
  expr.operand = left;
  expr.right = right;
  return add_expression(expr);
}

ExprId Parser::parse_unary() {
  TokenKind op = kind();
  if (op != TokenKind::kMinus && op != TokenKind::kPlus && op != TokenKind::kNot) {
    return parse_primary();
  }
  Nesting nesting(*this);
  if (!nesting.entered()) return error_expression();
  Expr expr;
  expr.kind = ExprKind::kUnary;
  expr.unary = op == TokenKind::kMinus  ? UnaryOp::kNegate
               : op == TokenKind::kPlus ? UnaryOp::kPlus
                                        : UnaryOp::kNot;
  expr.op = {take().begin};
  expr.operand = parse_unary();
  expr.span = {expr.op, tree_[expr.operand].span.end};
  return add_expression(expr);
}

ExprId Parser::parse_primary() {
  switch (kind()) {
    case TokenKind::kInteger:
    case TokenKind::kReal:
    case TokenKind::kString:
    case TokenKind::kWideString:
    case TokenKind::kDuration:
    case TokenKind::kDate:
    case TokenKind::kTrue:
    case TokenKind::kFalse:
      return parse_literal({}, here(), false);
    case TokenKind::kTypePrefix:
      return parse_typed_literal();
    case TokenKind::kLeftParen:
      return parse_parenthesised();
    case TokenKind::kLeftBracket:
      return parse_array_initializer();
    case TokenKind::kDirect:
      return parse_variable();
    case TokenKind::kAnd:
    case TokenKind::kOr:
    case TokenKind::kXor:
    case TokenKind::kMod:
      return parse_operator_call();
    case TokenKind::kDot:
      return parse_global_name();
    default:
      break;
  }
  if (at_type_argument()) return parse_type_argument();
  if (is_name(kind())) return parse_variable();
  if (is_keyword(kind())) {
    report_here(Code::kExpectedExpression,
                "a value belongs here, but " + describe(*current_) + " is a reserved word");
  } else {
    report_here(Code::kExpectedExpression, "a value belongs here, found " + describe(*current_),
                step_fix());
  }
  return error_expression();
}

// The way out where `x++` or `x--` was written.
std::string Parser::step_fix() const {
  if (current_ - first_ < 3) return {};
  const Token& second = current_[-1];
  const Token& first = current_[-2];
  const bool step = first.kind == second.kind && first.begin + 1 == second.begin &&
                    (first.kind == TokenKind::kPlus || first.kind == TokenKind::kMinus);
  const Token& variable = current_[-3];
  if (!step || !is_name(variable.kind)) return {};
  const std::string name(text(variable));
  return "write `" + name + " := " + name + (first.kind == TokenKind::kPlus ? " + 1`" : " - 1`");
}

// `AND(a, b)`: the operators are functions too (IEC 61131-3 6.6.2.5).
ExprId Parser::parse_operator_call() {
  if (next_kind() != TokenKind::kLeftParen) {
    report_here(Code::kExpectedExpression,
                "a value belongs here, found the operator " + describe(*current_));
    return error_expression();
  }
  Expr expr;
  expr.kind = ExprKind::kName;
  expr.name = name_of(take());
  expr.span = expr.name.span;
  return parse_postfix(add_expression(expr));
}

ExprId Parser::parse_parenthesised() {
  const Token open = take();
  ExprId inner = parse_expression();
  if (auto op = assign_op_here(); op && !panic_) inner = parse_assign_expression(inner, *op);
  close_bracket(TokenKind::kRightParen, open);
  Expr& expr = tree_.exprs[inner.index];
  expr.parenthesised = true;
  expr.span = span_from({open.begin});
  // (ADR(x) + 2)^, (p)[2]
  const bool led = kind() == TokenKind::kCaret || kind() == TokenKind::kLeftBracket;
  return led && !panic_ ? parse_postfix(inner) : inner;
}

// `.x`: the global variable, even where a local one has the same name.
ExprId Parser::parse_global_name() {
  Expr expr;
  expr.kind = ExprKind::kName;
  expr.global = true;
  base::SourcePos begin = {take().begin};
  if (kind() == TokenKind::kInteger) {
    report(Code::kExpectedExpression, {begin, {current_->begin + current_->length}},
           "a REAL has digits on both sides of its point",
           "write `0." + std::string(text(*current_)) + '`');
    return error_expression();
  }
  expr.name = parse_name("global variable");
  if (panic_) return error_expression();
  expr.span = span_from(begin);
  return parse_postfix(add_expression(expr));
}

// A type that is no plain name, as an argument: SIZEOF(STRING[20]), __NEW(ARRAY[0..3] OF INT).
bool Parser::at_type_argument() const {
  TokenKind next = next_kind();
  switch (kind()) {
    case TokenKind::kArray:
      return true;
    case TokenKind::kPointer:
    case TokenKind::kReference:
      return next == TokenKind::kTo;
    case TokenKind::kRefTo:
      return is_name(next) || next == TokenKind::kArray;
    case TokenKind::kStringType:
    case TokenKind::kWideStringType:
    case TokenKind::kUnicodeStringType:
      return next == TokenKind::kLeftBracket || next == TokenKind::kLeftParen;
    default:
      return false;
  }
}

ExprId Parser::parse_type_argument() {
  Expr expr;
  expr.kind = ExprKind::kType;
  base::SourcePos begin = here();
  expr.number = parse_spec().index;
  expr.span = span_from(begin);
  return add_expression(expr);
}

ExprId Parser::error_expression() {
  Expr expr;
  expr.span = current_->span();
  return add_expression(expr);
}

ExprId Parser::add_expression(const Expr& expr) {
  Expr added = expr;
  uint32_t below = height_below(expr);
  if (below >= base::kMaxExpressionHeight) {
    report(Code::kTooComplex, expr.span,
           "this expression applies more than " + std::to_string(base::kMaxExpressionHeight) +
               " operators to each other's results",
           "compute parts of it into variables first");
    added = Expr();
    added.span = expr.span;
  } else {
    added.height = static_cast<uint16_t>(below + 1);
  }
  return tree_.exprs.add(added);
}

uint32_t Parser::height_below(const Expr& expr) const {
  uint32_t below = std::max(height(expr.operand), height(expr.right));
  const bool arguments = expr.kind == ExprKind::kCall || expr.kind == ExprKind::kStructInit;
  for (uint32_t i = expr.list.first; i < expr.list.first + expr.list.count; ++i) {
    below = std::max(below, height(arguments ? tree_.args[i].value : tree_.expr_lists[i]));
  }
  return below;
}

}  // namespace frontend
