// Variables and what follows them: members, bits, indices, calls.
#include "frontend/parse/diagram.h"
#include "frontend/parse/instruction_list.h"

namespace frontend {

ExprId Parser::parse_variable() {
  if (wires_ != nullptr && next_kind() != TokenKind::kLeftParen) {
    if (const ExprId value = wires_->wire_value(); value.valid()) return parse_postfix(value);
  }
  Expr expr;
  const Token token = take();
  expr.name = name_of(token);
  expr.span = token.span();
  if (token.kind == TokenKind::kDirect) {
    set_direct(expr, token);
  } else {
    expr.kind = token.kind == TokenKind::kThis    ? ExprKind::kThis
                : token.kind == TokenKind::kSuper ? ExprKind::kSuper
                                                  : ExprKind::kName;
  }
  return parse_postfix(add_expression(expr));
}

void Parser::set_direct(Expr& expr, const Token& token) {
  DecodedAddress decoded = parse_direct_address(token);
  if (!decoded.problem && (decoded.incomplete || decoded.address.area == ir::DirectArea::kNone)) {
    note_only(Code::kBadDirectAddress, token.span(), "this address is not complete",
              "write it like %IX0.0 or %QW4");
    decoded.address = {};
  }
  expr.kind = ExprKind::kDirect;
  expr.number = static_cast<uint32_t>(tree_.directs.size());
  tree_.directs.push_back({decoded.address, add_levels(decoded.levels)});
}

ExprId Parser::parse_postfix(ExprId operand) {
  for (;;) {
    switch (kind()) {
      case TokenKind::kDot:
        operand = parse_member(operand);
        break;
      case TokenKind::kLeftBracket:
        operand = parse_index(operand);
        break;
      case TokenKind::kLeftParen:
        operand = parse_call(operand);
        break;
      case TokenKind::kCaret: {
        Expr expr;
        expr.kind = ExprKind::kDeref;
        expr.operand = operand;
        expr.op = {take().begin};
        expr.span = span_from(tree_[operand].span.begin);
        operand = add_expression(expr);
        break;
      }
      default:
        return operand;
    }
    if (panic_) return operand;
  }
}

// `.name`, `.3`, `.%X3`
ExprId Parser::parse_member(ExprId operand) {
  Expr expr;
  expr.op = {take().begin};
  expr.operand = operand;
  const Token token = *current_;
  if (is_name(token.kind)) {
    expr.kind = ExprKind::kMember;
    expr.name = name_of(take());
  } else if (token.kind == TokenKind::kTypePrefix && is_name(next_kind())) {
    take();
    expr.kind = ExprKind::kQualified;  // Lib.Color#Red
    expr.number = tree_.add_name(prefix_of(token));
    expr.name = name_of(take());
  } else if (token.kind == TokenKind::kInteger) {
    expr.kind = ExprKind::kBit;
    DecodedInteger number = decode_integer(text(take()));
    if (number.problem) report_problem(*number.problem, token);
    expr.number = static_cast<uint32_t>(std::min<uint64_t>(number.value, 0xffff'ffff));
  } else if (token.kind == TokenKind::kDirect && at_process_address()) {
    expr.name = name_of(take());  // Resource.%IX0.0 of VAR_ACCESS
    set_direct(expr, token);
  } else if (token.kind == TokenKind::kDirect) {
    expr.kind = ExprKind::kBit;
    DecodedPart part = decode_part(text(take()));
    if (part.problem) report_problem(*part.problem, token);
    expr.number = part.number;
    expr.bit_size = part.bit_size;
  } else {
    parse_name("member");  // reports
    return operand;
  }
  expr.span = span_from(tree_[operand].span.begin);
  return add_expression(expr);
}

bool Parser::at_process_address() const {
  char area = text(*current_).size() > 1 ? text(*current_)[1] : '\0';
  return std::string_view("iIqQmM").find(area) != std::string_view::npos;
}

ExprId Parser::parse_index(ExprId operand) {
  const Token open = take();
  size_t mark = expr_stack_.size();
  do {
    expr_stack_.push_back(parse_expression());
  } while (!panic_ && accept(TokenKind::kComma));
  close_bracket(TokenKind::kRightBracket, open);
  Expr expr;
  expr.kind = ExprKind::kIndex;
  expr.operand = operand;
  expr.op = {open.begin};
  expr.list = move_tail(expr_stack_, mark, tree_.expr_lists);
  expr.span = span_from(tree_[operand].span.begin);
  return add_expression(expr);
}

ExprId Parser::parse_call(ExprId operand) {
  Expr expr;
  expr.kind = ExprKind::kCall;
  expr.operand = operand;
  expr.op = here();
  expr.list = parse_arguments();
  expr.open_list = expr.list.count != 0 && current_[-2].kind == TokenKind::kComma;
  expr.span = span_from(tree_[operand].span.begin);
  return add_expression(expr);
}

Range32 Parser::parse_arguments() {
  const Token open = take();
  size_t mark = arg_stack_.size();
  if (kind() != TokenKind::kRightParen) {
    do {
      arg_stack_.push_back(parse_argument());
    } while (!panic_ && accept(TokenKind::kComma) && kind() != TokenKind::kRightParen);
  }
  close_bracket(TokenKind::kRightParen, open);
  return move_tail(arg_stack_, mark, tree_.args);
}

// `value`, `in := value`, `out => variable`, `NOT out => variable`
Arg Parser::parse_argument() {
  Arg arg;
  base::SourcePos begin = here();
  if (kind() == TokenKind::kNot && is_name(next_kind()) && peek(2).kind == TokenKind::kArrow) {
    take();
    arg.negated = true;
  }
  if (is_name(kind()) && (next_kind() == TokenKind::kAssign || next_kind() == TokenKind::kArrow)) {
    arg.name = name_of(take());
    arg.output = take().kind == TokenKind::kArrow;
    bool empty = kind() == TokenKind::kComma || kind() == TokenKind::kRightParen;
    if (!empty && at_instruction_argument()) {
      arg.value = InstructionList(*this).argument();
    } else if (!empty) {
      arg.value = parse_listed_value();
    }
  } else {
    arg.value = parse_expression();
  }
  arg.span = span_from(begin);
  return arg;
}

void Parser::close_bracket(TokenKind close, const Token& open) {
  if (accept(close) || panic_) return;
  base::Diagnostic diagnostic{
      Code::kUnclosedBracket,
      current_->span(),
      "expected `" + std::string(token_text(close)) + "`, found " + describe(*current_),
      {},
      {}};
  diagnostic.notes.push_back({open.span(), "for the bracket that opens here"});
  diagnostics_.add(std::move(diagnostic));
  panic_ = true;
}

}  // namespace frontend
