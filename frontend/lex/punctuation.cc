#include "base/diagnostics_render.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/scanner.h"

namespace frontend {

using base::DiagnosticCode;

TokenKind Scanner::scan_punctuation() {
  char next = peek(1);
  switch (peek()) {
    case '(':
      return take(1, TokenKind::kLeftParen);
    case ')':
      return take(1, TokenKind::kRightParen);
    case '[':
      return take(1, TokenKind::kLeftBracket);
    case ']':
      return take(1, TokenKind::kRightBracket);
    case ',':
      return take(1, TokenKind::kComma);
    case ';':
      return take(1, TokenKind::kSemicolon);
    case '^':
      return take(1, TokenKind::kCaret);
    case '/':
      return take(1, TokenKind::kSlash);
    case ':':
      return next == '=' ? take(2, TokenKind::kAssign) : take(1, TokenKind::kColon);
    case '.':
      return next == '.' ? take(2, TokenKind::kRange) : take(1, TokenKind::kDot);
    case '*':
      return next == '*' ? take(2, TokenKind::kPower) : take(1, TokenKind::kStar);
    case '>':
      return next == '=' ? take(2, TokenKind::kGreaterEqual) : take(1, TokenKind::kGreater);
    case '<':
      if (next == '>') return take(2, TokenKind::kNotEqual);
      return next == '=' ? take(2, TokenKind::kLessEqual) : take(1, TokenKind::kLess);
    case '=':
      if (next == '=') return foreign(TokenKind::kEqual, 2, "write `=` to compare");
      return next == '>' ? take(2, TokenKind::kArrow) : take(1, TokenKind::kEqual);
    case '+':
      if (next == '=') return foreign(TokenKind::kAssign, 2, "write `a := a + b`");
      return take(1, TokenKind::kPlus);
    case '-':
      if (next == '=') return foreign(TokenKind::kAssign, 2, "write `a := a - b`");
      return take(1, TokenKind::kMinus);
    case '&':
      if (next == '&') return foreign(TokenKind::kAmpersand, 2, "write AND, or AND_THEN");
      return take(1, TokenKind::kAmpersand);
    case '|':
      return foreign(TokenKind::kOr, next == '|' ? 2 : 1, "write OR, or OR_ELSE");
    case '?':
      return next == '=' ? take(2, TokenKind::kAttempt) : bad_characters();
    case '!':
      if (next == '=') return foreign(TokenKind::kNotEqual, 2, "write `<>`");
      return foreign(TokenKind::kNot, 1, "write NOT");
    case '%':
      return foreign(TokenKind::kMod, 1, "write MOD for the remainder");
    default:
      return bad_characters();
  }
}

// Operators of C are understood, so that one mistake gives one message.
TokenKind Scanner::foreign(TokenKind kind, uint32_t length, const char* fix) {
  std::string text(text_.substr(at_, length));
  report(DiagnosticCode::kForeignOperator, at_, at_ + length,
         '`' + text + "` is not an operator of Structured Text", fix);
  return take(length, kind);
}

TokenKind Scanner::bad_characters() {
  static constexpr std::string_view kMeaningful = "()[],;^/:.*><=+-&|!%'\"{";
  size_t begin = at_;
  while (!at_end() && !is_name_part(peek()) && !is_space(peek()) &&
         kMeaningful.find(peek()) == std::string_view::npos) {
    ++at_;
  }
  std::string_view text = text_.substr(begin, at_ - begin);
  static constexpr size_t kShown = 20;
  report(DiagnosticCode::kBadCharacter, begin, at_,
         '`' + base::printable(text.substr(0, kShown)) +
             "` has no meaning in Structured Text outside comments and strings",
         "remove it");
  return TokenKind::kEnd;
}

}  // namespace frontend
