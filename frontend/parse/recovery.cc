#include "frontend/parse/parser.h"
#include "frontend/parse/token_sets.h"

namespace frontend {

// At the end of a file whose rest a comment swallowed, everything is missing.
bool Parser::swallowed_by_comment() const {
  if (kind() != TokenKind::kEnd) return false;
  for (const base::Diagnostic& message : diagnostics_.all()) {
    bool here = message.code == Code::kUnterminatedComment && message.span.begin.offset >= base_;
    if (here) return true;
  }
  return false;
}

void Parser::report(Code code, base::SourceSpan span, std::string text, std::string fix) {
  if (!panic_ && !swallowed_by_comment()) {
    diagnostics_.add(code, span, std::move(text), std::move(fix));
  }
  panic_ = true;
}

void Parser::note_only(Code code, base::SourceSpan span, std::string text, std::string fix) {
  if (panic_ || swallowed_by_comment()) return;
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

void Parser::report_here(Code code, std::string text, std::string fix) {
  report(code, current_->span(), std::move(text), std::move(fix));
}

// A string without its closing quote has swallowed the rest of its line, and the end with it.
bool Parser::has_open_string(const Token& opening) const {
  for (const base::Diagnostic& message : diagnostics_.all()) {
    const base::SourcePos at = message.span.begin;
    if (message.code != Code::kUnterminatedString) continue;
    if (at.offset > opening.begin && at.offset < current_->begin) return true;
  }
  return false;
}

// At the opening keyword, whose place is certain; where the end was missed is a note.
void Parser::report_missing_end(const Token& opening, TokenKind end, std::string fix) {
  std::string closing(token_text(end));
  if (fix.empty()) fix = "write `" + closing + "` after the last line that belongs to it";
  base::Diagnostic diagnostic{Code::kMissingEnd,
                              opening.span(),
                              describe(opening) + " has no `" + closing + '`',
                              std::move(fix),
                              {}};
  diagnostic.notes.push_back(
      {current_->span(), '`' + closing + "` was expected before " + describe(*current_)});
  if (panic_ || swallowed_by_comment() || has_open_string(opening)) return;
  diagnostics_.add(std::move(diagnostic));
}

void Parser::report_problem(const LiteralProblem& problem, const Token& token) {
  base::SourceSpan span = token.span();
  if (problem.length != 0) {
    span.begin.offset += std::min(problem.at, token.length);
    span.end.offset = std::min(span.begin.offset + problem.length, span.end.offset);
  }
  note_only(problem.code, span, problem.text, problem.fix);
}

// Is the token before this one a string without its closing quote? It was reported,
// and the semicolon that is missing is inside it.
bool Parser::swallowed_by_string() const {
  if (current_ == first_) return false;
  const Token& before = current_[-1];
  if (before.kind != TokenKind::kString && before.kind != TokenKind::kWideString) return false;
  std::string_view string = text(before);
  return string.size() < 2 || string.back() != string.front();
}

// After the last token, not at the next one, which may be many lines below.
void Parser::report_missing_semicolon(const char* what) {
  if (swallowed_by_string()) return;
  base::SourcePos end = last_end();
  note_only(Code::kMissingSemicolon, {end, {end.offset + 1}},
            std::string("`;` is missing after this ") + what, "write `;` here");
}

void Parser::not_supported(base::SourceSpan span, const std::string& what, std::string fix) {
  note_only(Code::kNotSupported, span, what + " not supported yet", std::move(fix));
}

void Parser::skip_to_statement_end() {
  while (kind() != TokenKind::kSemicolon && !is_statement_boundary(kind())) take();
  accept(TokenKind::kSemicolon);
  panic_ = false;
}

void Parser::skip_to_declaration_end() { skip_to_statement_end(); }

void Parser::skip_to(TokenKind wanted) {
  while (kind() != wanted && kind() != TokenKind::kSemicolon && !is_statement_boundary(kind())) {
    take();
  }
}

void Parser::skip_past(TokenKind end) {
  while (kind() != end && kind() != TokenKind::kEnd) take();
  accept(end);
}

void Parser::skip_block(TokenKind end) {
  while (kind() != end && kind() != TokenKind::kEnd && !is_pou_end(kind())) take();
  accept(end);
}

}  // namespace frontend
