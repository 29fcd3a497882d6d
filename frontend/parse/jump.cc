// Jumps and labels, __TRY, and the mocks of tests.
#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {
namespace {

bool begins_type(TokenKind kind, std::string_view text, TokenKind next) {
  switch (kind) {
    case TokenKind::kArray:
    case TokenKind::kPointer:
    case TokenKind::kReference:
    case TokenKind::kRefTo:
    case TokenKind::kStringType:
    case TokenKind::kWideStringType:
      return true;
    default:
      return is_elementary_name(text) && next != TokenKind::kLeftParen;  // TIME() is a call
  }
}

}  // namespace

// Statements that begin with words which are names elsewhere; false when it is none of them.
bool Parser::parse_soft_statement() {
  if (kind() == TokenKind::kJump && is_keyword(next_kind())) {
    take();
    reject_label();
    return true;
  }
  if (!is_name(kind())) return false;
  if (kind() == TokenKind::kTry) {
    parse_try();
  } else if (next_kind() == TokenKind::kColon) {
    parse_label();
  } else if (kind() == TokenKind::kJump && is_name(next_kind())) {
    parse_jump_to_label();
  } else if ((kind() == TokenKind::kMock || kind() == TokenKind::kMockFunction) &&
             is_name(next_kind())) {
    parse_mock();
  } else {
    return false;
  }
  return true;
}

// A label, or where a jump goes to, is a reserved word.
void Parser::reject_label() {
  parse_name("label");
  take();
  if (!accept(TokenKind::kColon)) accept(TokenKind::kSemicolon);
  panic_ = false;
}

// `a : INT;` among statements is a declaration: a type stands behind the colon, in its row.
void Parser::parse_label() {
  const Token& type = current_[2];
  const uint32_t from = current_[1].begin + 1;
  const bool same_row = text_.substr(from - base_, type.begin - from).find('\n') == text_.npos;
  if (same_row &&
      begins_type(type.kind, text(type), current_[type.kind == TokenKind::kEnd ? 2 : 3].kind)) {
    report(Code::kExpectedStatement, {{current_->begin}, {type.begin + type.length}},
           "variables are declared in front of the statements",
           "write it between VAR and END_VAR: `VAR " + std::string(text(*current_)) + " : " +
               std::string(text(type)) + " ... END_VAR`");
    return skip_to_statement_end();
  }
  Stmt stmt;
  stmt.kind = StmtKind::kLabel;
  stmt.span = current_->span();
  stmt.name = tree_.add_name(name_of(take()));
  take();
  add_statement(stmt);
}

// JMP label;
void Parser::parse_jump_to_label() {
  Stmt stmt;
  stmt.kind = StmtKind::kJump;
  base::SourcePos begin = {take().begin};
  stmt.name = tree_.add_name(name_of(take()));
  stmt.span = span_from(begin);
  add_statement(stmt);
  finish_statement("statement");
}

// __TRY ... __CATCH(e) ... __FINALLY ... __ENDTRY
void Parser::parse_try() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kTry;
  stmt.span = opening.span();
  accept(TokenKind::kSemicolon);
  stmt.body = parse_body(TokenKind::kEndTry);
  Branch parts[2];  // CATCH's and FINALLY's
  while (kind() == TokenKind::kCatch || kind() == TokenKind::kFinally) {
    const Token part = take();
    bool is_catch = part.kind == TokenKind::kCatch;
    if ((is_catch ? stmt.has_catch : stmt.has_finally) || (is_catch && stmt.has_finally)) {
      note_only(Code::kUnexpectedEnd, part.span(),
                describe(part) + " stands here a second time, or after __FINALLY",
                "write __TRY ... __CATCH(e) ... __FINALLY ... __ENDTRY");
    }
    if (is_catch) stmt.has_catch = true;
    if (!is_catch) stmt.has_finally = true;
    if (is_catch && kind() == TokenKind::kLeftParen) stmt.target = parse_catch_variable();
    accept(TokenKind::kSemicolon);
    parts[is_catch ? 0 : 1].body = parse_body(TokenKind::kEndTry);
  }
  stmt.arms = {static_cast<uint32_t>(tree_.branches.size()), 2};
  tree_.branches.insert(tree_.branches.end(), {parts[0], parts[1]});
  if (!stmt.has_catch && !stmt.has_finally && kind() == TokenKind::kEndTry) {
    note_only(Code::kExpected, current_->span(),
              "expected `__CATCH` or `__FINALLY` before `__ENDTRY`");
  }
  add_statement(stmt);
  close_statement(opening, TokenKind::kEndTry);
}

ExprId Parser::parse_catch_variable() {
  const Token open = take();
  ExprId variable;
  if (kind() != TokenKind::kRightParen) variable = parse_expression();
  close_bracket(TokenKind::kRightParen, open);
  if (panic_) skip_to(TokenKind::kEndTry);
  panic_ = false;
  return variable;
}

// MOCK path;  MOCK_FUNCTION path [RETURNS value];
void Parser::parse_mock() {
  Stmt stmt;
  base::SourcePos begin = here();
  bool function = take().kind == TokenKind::kMockFunction;
  stmt.kind = function ? StmtKind::kMockFunction : StmtKind::kMock;
  stmt.target = parse_variable();
  if (function && !panic_ && accept(TokenKind::kReturns)) stmt.value = parse_expression();
  stmt.span = span_from(begin);
  add_statement(stmt);
  finish_statement("statement");
}

// MOCK_FUNCTION Name : T ... END_MOCK_FUNCTION, as opposed to the statement.
bool Parser::at_mock_function_block() const {
  if (kind() != TokenKind::kMockFunction || !is_name(next_kind())) return false;
  size_t at = 2;
  while (peek(at).kind == TokenKind::kDot && is_name(peek(at + 1).kind)) at += 2;
  return peek(at).kind == TokenKind::kColon || is_var_start(peek(at).kind);
}

}  // namespace frontend
