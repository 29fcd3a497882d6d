#include "frontend/parse/foreign_words.h"
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"
#include "ir/types/types.h"

namespace frontend {

Range32 Parser::parse_statements(bool in_case) {
  size_t mark = statement_stack_.size();
  while (!list_ends(in_case)) parse_statement();
  return move_tail(statement_stack_, mark, tree_.stmt_lists);
}

bool Parser::list_ends(bool in_case) {
  // What most statements begin with.
  if (kind() == TokenKind::kName) return in_case && at_case_label();
  if (is_statement_keyword(kind())) return false;
  for (;;) {
    if (kind() == TokenKind::kEnd || is_file_level_start(kind()) || is_pou_end(kind())) return true;
    if (at_member() || at_soft_declaration() || at_mock_function_block()) return true;
    if (at_chart_element()) return true;
    if (in_property_ && at_accessor()) return true;
    if (in_case && at_case_label()) return true;
    if (!is_closing(kind())) return false;
    if (!report_stray_end()) return true;
  }
}

// True when the current END_x, ELSE, ... belongs to nothing that is open; it was skipped.
bool Parser::report_stray_end() {
  auto open = [this](TokenKind end) { return open_[static_cast<uint8_t>(end)] != 0; };
  bool expected = open(kind());
  if (kind() == TokenKind::kElse) expected = open(TokenKind::kEndIf) || open(TokenKind::kEndCase);
  if (kind() == TokenKind::kElsif) expected = open(TokenKind::kEndIf);
  if (kind() == TokenKind::kUntil) expected = open(TokenKind::kEndRepeat);
  if (kind() == TokenKind::kCatch || kind() == TokenKind::kFinally) {
    expected = open(TokenKind::kEndTry);
  }
  // A wrong end inside a member is that member's: close_pou() says so.
  bool in_member = open(TokenKind::kEndMethod) || open(TokenKind::kEndAction);
  if (is_member_end(kind())) expected = expected || in_member;
  if (kind() == TokenKind::kEndNamespace) expected = tree_.in_namespace(scope_);
  if (expected) return false;
  const Token token = take();
  note_only(Code::kUnexpectedEnd, token.span(),
            describe(token) + " stands here, but nothing that it belongs to is open",
            "remove it, or open the construct above");
  if (token.kind == TokenKind::kElsif || token.kind == TokenKind::kUntil) {
    panic_ = true;  // its condition is skipped with it
    skip_to(TokenKind::kThen);
    accept(TokenKind::kThen);
  } else if (token.kind == TokenKind::kCatch && accept(TokenKind::kLeftParen)) {
    panic_ = true;
    skip_to(TokenKind::kRightParen);
    accept(TokenKind::kRightParen);
  }
  accept(TokenKind::kSemicolon);
  panic_ = false;
  return true;
}

void Parser::parse_statement() {
  if (accept(TokenKind::kSemicolon)) return;
  Nesting nesting(*this);
  if (!nesting.entered()) {
    take();  // the keyword, so that skipping makes progress
    return skip_to_statement_end();
  }
  switch (kind()) {
    case TokenKind::kIf:
      return parse_if();
    case TokenKind::kCase:
      return parse_case();
    case TokenKind::kFor:
      return parse_for();
    case TokenKind::kWhile:
      return parse_while();
    case TokenKind::kRepeat:
      return parse_repeat_loop();
    case TokenKind::kExit:
    case TokenKind::kReturn:
      if (next_kind() == TokenKind::kColon) return reject_label();
      return parse_jump(kind() == TokenKind::kExit ? StmtKind::kExit : StmtKind::kReturn);
    default:
      break;
  }
  if (is_var_start(kind())) {
    report_here(Code::kWrongSection, "variable blocks stand before the first statement",
                "move this block up");
    skip_block(TokenKind::kEndVar);
    panic_ = false;
    return;
  }
  if (!parse_soft_statement()) parse_simple_statement();
}

// Assignment, call, CONTINUE, or nothing that could be understood.
void Parser::parse_simple_statement() {
  TokenKind next = next_kind();
  bool variable = next == TokenKind::kAssign || next == TokenKind::kDot ||
                  next == TokenKind::kLeftBracket || next == TokenKind::kEqual ||
                  next == TokenKind::kLeftParen || next == TokenKind::kAttempt ||
                  next == TokenKind::kCaret;
  if (kind() == TokenKind::kContinue && !variable) return parse_jump(StmtKind::kContinue);
  base::SourcePos begin = here();
  if (!is_name(kind()) && kind() != TokenKind::kDirect && kind() != TokenKind::kDot) {
    bool value = kind() == TokenKind::kInteger || kind() == TokenKind::kLeftParen ||
                 kind() == TokenKind::kTypePrefix || kind() == TokenKind::kReal;
    if (!value) {
      report_here(Code::kExpectedStatement,
                  "a statement belongs here, found " + describe(*current_));
      take();
      return skip_to_statement_end();
    }
    ExprId left = parse_expression();
    return finish_simple(left, begin);
  }
  ExprId left = parse_primary();
  // `a + 1;` is an expression without effect; `a = 1;` most likely an assignment.
  if (!panic_ && kind() != TokenKind::kEqual) left = parse_operators(left, 0);
  finish_simple(left, begin);
}

void Parser::finish_simple(ExprId left, base::SourcePos begin) {
  // `fb.act;` may call an action; lowering knows.
  const ExprKind shape = tree_[left].kind;
  bool name = (shape == ExprKind::kName || shape == ExprKind::kMember) &&
              kind() == TokenKind::kSemicolon && current_[-1].kind == TokenKind::kName;
  bool call = shape == ExprKind::kCall || name;
  auto op = assign_op_here();
  if (op && !panic_) {
    parse_assignment(left, *op, begin);
  } else if (kind() == TokenKind::kEqual && !panic_) {
    note_only(Code::kAssignEquals, current_->span(), "`=` compares; an assignment is needed here",
              "write `:=` to assign");
    parse_assignment(left, AssignOp::kAssign, begin);
  } else if (call && !panic_) {
    Stmt stmt;
    stmt.kind = StmtKind::kCall;
    stmt.value = left;
    stmt.span = span_from(begin);
    add_statement(stmt);
  } else {
    bool complete = kind() == TokenKind::kSemicolon || is_statement_boundary(kind());
    if (complete) {
      report(Code::kNoEffect, span_from(begin),
             "this is no statement: nothing is assigned or called",
             "write `:=` and a value, or `()` to call");
    } else {
      report_here(
          Code::kExpected,
          "expected `:=` or `(` after " + describe(current_[-1]) + ", found " + describe(*current_),
          statement_fix(text(current_[-1]), is_name(kind()) ? text(*current_) : ""));
    }
    Stmt stmt;
    stmt.kind = StmtKind::kError;
    stmt.span = span_from(begin);
    add_statement(stmt);
  }
  finish_statement("statement");
}

void Parser::parse_jump(StmtKind statement) {
  Stmt stmt;
  stmt.kind = statement;
  stmt.span = take().span();
  add_statement(stmt);
  finish_statement("statement");
}

void Parser::finish_statement(const char* what) {
  if (panic_) return skip_to_statement_end();
  if (accept(TokenKind::kSemicolon)) return;
  report_missing_semicolon(what);
  bool goes_on = on_new_line() || is_statement_boundary(kind()) ||
                 next_kind() == TokenKind::kAssign || next_kind() == TokenKind::kLeftParen;
  if (!goes_on) skip_to_statement_end();
}

}  // namespace frontend
