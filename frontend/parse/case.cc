#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

void Parser::parse_case() {
  const Token opening = take();
  Stmt stmt;
  stmt.kind = StmtKind::kCase;
  stmt.value = parse_expression();
  parse_head(TokenKind::kOf, "after the value of CASE");
  stmt.span = span_from({opening.begin});
  ++open_[static_cast<uint8_t>(TokenKind::kEndCase)];
  size_t mark = case_stack_.size();
  while (accept(TokenKind::kSemicolon)) {
  }
  for (;;) {
    if (at_case_label()) {
      parse_case_arm();
    } else if (!list_ends(false)) {
      report_here(Code::kExpected, "expected a label and `:` in front of the statements of CASE");
      panic_ = false;
      size_t statements = statement_stack_.size();
      while (!list_ends(true)) parse_statement();
      statement_stack_.resize(statements);
    } else {
      break;
    }
  }
  if (accept(TokenKind::kElse)) {
    accept(TokenKind::kColon);
    stmt.has_else = true;
    stmt.else_body = parse_statements();
  }
  --open_[static_cast<uint8_t>(TokenKind::kEndCase)];
  stmt.arms = move_tail(case_stack_, mark, tree_.cases);
  add_statement(stmt);
  close_statement(opening, TokenKind::kEndCase);
}

void Parser::parse_case_arm() {
  CaseArm arm;
  base::SourcePos begin = here();
  arm.labels = parse_case_labels();
  if (!panic_) expect(TokenKind::kColon, "after the labels of CASE");
  if (panic_) {
    skip_to(TokenKind::kColon);
    if (!accept(TokenKind::kColon)) accept(TokenKind::kSemicolon);
    panic_ = false;
  }
  arm.span = span_from(begin);
  arm.body = parse_statements(true);
  case_stack_.push_back(arm);
}

Range32 Parser::parse_case_labels() {
  size_t mark = label_stack_.size();
  do {
    CaseLabel label;
    label.low = parse_expression();
    if (!panic_ && accept(TokenKind::kRange)) label.high = parse_expression();
    label_stack_.push_back(label);
  } while (!panic_ && accept(TokenKind::kComma));
  return move_tail(label_stack_, mark, tree_.labels);
}

// Statements never begin with a literal. A name begins a label when, after its members and the
// arguments of a function, `:`, `,` or `..` follows; `A + 1:` needs a look at the whole line.
bool Parser::at_case_label() const {
  switch (kind()) {
    case TokenKind::kInteger:
    case TokenKind::kMinus:
    case TokenKind::kPlus:
    case TokenKind::kTypePrefix:
    case TokenKind::kTrue:
    case TokenKind::kFalse:
    case TokenKind::kString:
    case TokenKind::kReal:
    case TokenKind::kDuration:
    case TokenKind::kDate:
      return true;
    default:
      break;
  }
  if (!is_name(kind()) && kind() != TokenKind::kLeftParen) return false;
  // The token behind the parenthesis that is closed; `at` where it is not closed soon.
  const auto behind_parentheses = [this](size_t at) {
    static constexpr size_t kMostTokens = 64;
    size_t open = 0;
    for (size_t i = at; i < at + kMostTokens; ++i) {
      const TokenKind ahead = peek(i).kind;
      if (ahead == TokenKind::kLeftParen) ++open;
      if (ahead == TokenKind::kRightParen && --open == 0) return i + 1;
      if (ahead == TokenKind::kSemicolon || is_statement_boundary(ahead)) break;
    }
    return at;
  };
  size_t at = kind() == TokenKind::kLeftParen ? 0 : 1;
  while (peek(at).kind == TokenKind::kDot && is_name(peek(at + 1).kind)) at += 2;
  if (peek(at).kind == TokenKind::kLeftParen) at = behind_parentheses(at);
  TokenKind next = peek(at).kind;
  if (next == TokenKind::kColon || next == TokenKind::kComma || next == TokenKind::kRange) {
    return true;
  }
  bool computed = next == TokenKind::kPlus || next == TokenKind::kMinus ||
                  next == TokenKind::kStar || next == TokenKind::kSlash || next == TokenKind::kMod;
  if (!computed) return false;
  static constexpr size_t kLongestLabel = 32;
  for (size_t i = at; i < at + kLongestLabel; ++i) {
    TokenKind ahead = peek(i).kind;
    if (ahead == TokenKind::kColon) return true;
    if (ahead == TokenKind::kSemicolon || ahead == TokenKind::kAssign ||
        is_statement_boundary(ahead)) {
      return false;
    }
  }
  return false;
}

}  // namespace frontend
