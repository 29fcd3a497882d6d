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
  for (;;) {
    if (kind() == TokenKind::kEnd || is_file_level_start(kind()) || is_pou_end(kind())) return true;
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
  if (expected) return false;
  const Token token = take();
  note_only(Code::kUnexpectedEnd, token.span(),
            describe(token) + " stands here, but nothing that it belongs to is open",
            "remove it, or open the construct above");
  if (token.kind == TokenKind::kElsif || token.kind == TokenKind::kUntil) {
    panic_ = true;  // its condition is skipped with it
    skip_to(TokenKind::kThen);
    accept(TokenKind::kThen);
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
      return parse_jump(StmtKind::kExit);
    case TokenKind::kReturn:
      return parse_jump(StmtKind::kReturn);
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
  if (!parse_unsupported_statement()) parse_simple_statement();
}

// Assignment, call, CONTINUE, or nothing that could be understood.
void Parser::parse_simple_statement() {
  TokenKind next = next_kind();
  bool variable = next == TokenKind::kAssign || next == TokenKind::kDot ||
                  next == TokenKind::kLeftBracket || next == TokenKind::kEqual ||
                  next == TokenKind::kLeftParen;
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
  bool call = tree_[left].kind == ExprKind::kCall;
  if (kind() == TokenKind::kAssign && !panic_) {
    take();
    parse_assignment(left, begin);
  } else if (kind() == TokenKind::kEqual && !panic_) {
    note_only(Code::kAssignEquals, current_->span(), "`=` compares; an assignment is needed here",
              "write `:=` to assign");
    take();
    parse_assignment(left, begin);
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
      report_here(Code::kExpected, "expected `:=` or `(` behind " + describe(current_[-1]) +
                                       ", found " + describe(*current_));
    }
    Stmt stmt;
    stmt.kind = StmtKind::kError;
    stmt.span = span_from(begin);
    add_statement(stmt);
  }
  finish_statement("statement");
}

void Parser::parse_assignment(ExprId target, base::SourcePos begin) {
  Stmt stmt;
  stmt.kind = StmtKind::kAssign;
  stmt.target = target;
  stmt.value = parse_expression();
  stmt.span = span_from(begin);
  add_statement(stmt);
  if (kind() != TokenKind::kAssign || panic_) return;
  not_supported(current_->span(), "assignments in a chain are",
                "write one assignment per variable");
  panic_ = true;
}

void Parser::parse_jump(StmtKind statement) {
  Stmt stmt;
  stmt.kind = statement;
  stmt.span = take().span();
  add_statement(stmt);
  finish_statement("statement");
}

// Constructs with a message of their own; false when the statement is none of them.
bool Parser::parse_unsupported_statement() {
  if (!is_name(kind())) return false;
  TokenKind next = next_kind();
  if (skip_unsupported_block()) return true;
  if (next == TokenKind::kColon) {
    not_supported({here(), {peek(1).begin + 1}}, "jump labels are");
    take();
    take();
    return true;
  }
  if (!is_name(next)) return false;
  if (kind() == TokenKind::kJump || is_word(*current_, "GOTO")) {
    not_supported(current_->span(), "jumps are", "use IF, WHILE, EXIT or RETURN");
  } else if (kind() == TokenKind::kTry) {
    not_supported(current_->span(), "__TRY is");
  } else if (peek(2).kind == TokenKind::kEqual &&
             (is_word(peek(1), "S") || is_word(peek(1), "R") || is_word(peek(1), "REF"))) {
    not_supported(peek(1).span(), "the assignments S=, R= and REF= are",
                  "write IF condition THEN variable := TRUE; END_IF");
  } else {
    return false;
  }
  take();
  skip_to_statement_end();
  return true;
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
