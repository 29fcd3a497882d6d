// IF, FOR, WHILE, REPEAT.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

// The word after a statement's head. Where it is missing, the head ends at the line's end.
void Parser::parse_head(TokenKind keyword, const char* where) {
  if (!panic_ && accept(keyword)) return;
  expect(keyword, where);
  if (!on_new_line()) skip_to(keyword);
  accept(keyword);
  accept(TokenKind::kSemicolon);
  panic_ = false;
}

Range32 Parser::parse_body(TokenKind end) {
  ++open_[static_cast<uint8_t>(end)];
  Range32 body = parse_statements();
  --open_[static_cast<uint8_t>(end)];
  return body;
}

// Real sources leave out the semicolon after END_x, so it is optional.
void Parser::close_statement(const Token& opening, TokenKind end) {
  if (!accept(end)) return report_missing_end(opening, end);
  accept(TokenKind::kSemicolon);
}

// condition THEN body, of IF and ELSIF; returns where its head ends.
base::SourcePos Parser::parse_branch() {
  Branch branch;
  branch.condition = parse_condition();
  parse_head(TokenKind::kThen, "after the condition");
  base::SourcePos head_end = last_end();
  branch.body = parse_body(TokenKind::kEndIf);
  branch_stack_.push_back(branch);
  return head_end;
}

void Parser::parse_if() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kIf;
  size_t mark = branch_stack_.size();
  stmt.span = {{opening.begin}, parse_branch()};
  bool else_if = false;  // in one line
  while (kind() == TokenKind::kElsif || kind() == TokenKind::kElse) {
    const Token token = take();
    else_if =
        else_if || (token.kind == TokenKind::kElse && kind() == TokenKind::kIf && !on_new_line());
    if (stmt.has_else) {
      note_only(Code::kUnexpectedEnd, token.span(),
                describe(token) + " stands after the ELSE of the same IF",
                "put ELSE after all ELSIF branches, and only one");
    }
    if (token.kind == TokenKind::kElsif) {
      parse_branch();
    } else {
      stmt.has_else = true;
      stmt.else_body = parse_body(TokenKind::kEndIf);
    }
  }
  stmt.arms = move_tail(branch_stack_, mark, tree_.branches);
  add_statement(stmt);
  if (else_if && kind() != TokenKind::kEndIf) {
    return report_missing_end(
        opening, TokenKind::kEndIf,
        "write `ELSIF`: `ELSE IF` begins another IF with an END_IF of its own");
  }
  close_statement(opening, TokenKind::kEndIf);
}

void Parser::parse_for() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kFor;
  stmt.target = is_name(kind()) ? parse_variable() : parse_primary();
  if (!panic_ && kind() == TokenKind::kEqual) {
    note_only(Code::kAssignEquals, current_->span(), "`=` compares; an assignment is needed here",
              "write `:=` to assign");
    take();
  } else if (!panic_) {
    expect(TokenKind::kAssign, "after the variable of FOR");
  }
  if (!panic_) stmt.from = parse_expression();
  if (!panic_) expect(TokenKind::kTo, "after the first value of FOR");
  if (!panic_) stmt.to = parse_expression();
  if (!panic_ && accept(TokenKind::kBy)) stmt.by = parse_expression();
  bool damaged = panic_;
  parse_head(TokenKind::kDo, "after the head of FOR");
  if (damaged && !stmt.from.valid()) stmt.from = error_expression();
  if (damaged && !stmt.to.valid()) stmt.to = error_expression();
  stmt.span = span_from({opening.begin});
  stmt.body = parse_body(TokenKind::kEndFor);
  add_statement(stmt);
  close_statement(opening, TokenKind::kEndFor);
}

void Parser::parse_while() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kWhile;
  stmt.value = parse_condition();
  parse_head(TokenKind::kDo, "after the condition");
  stmt.span = span_from({opening.begin});
  stmt.body = parse_body(TokenKind::kEndWhile);
  add_statement(stmt);
  close_statement(opening, TokenKind::kEndWhile);
}

void Parser::parse_repeat_loop() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kRepeat;
  stmt.span = opening.span();
  stmt.body = parse_body(TokenKind::kEndRepeat);
  if (accept(TokenKind::kUntil)) {
    stmt.value = parse_condition();
    if (panic_) skip_to(TokenKind::kEndRepeat);
    accept(TokenKind::kSemicolon);
    panic_ = false;
  } else {
    if (kind() == TokenKind::kEndRepeat) {
      note_only(Code::kExpected, current_->span(),
                "expected `UNTIL` and a condition before `END_REPEAT`");
    }
    stmt.value = error_expression();
  }
  add_statement(stmt);
  close_statement(opening, TokenKind::kEndRepeat);
}

}  // namespace frontend
