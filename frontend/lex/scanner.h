// Inside of the lexer: the scanning position in one file and the scanners of
// the token classes. Every read is bounded by the file's end.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics.h"
#include "frontend/lex/conditions.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/token.h"

namespace frontend {

class Scanner {
 public:
  Scanner(std::string_view text, uint32_t base, base::Diagnostics& diagnostics,
          const LexOptions& options)
      : text_(text),
        base_(base),
        diagnostics_(diagnostics),
        options_(options),
        conditions_(options) {}

  TokenList run();

 private:
  // trivia.cc: white space, comments, pragmas.
  void skip_trivia();
  bool skip_comment();
  void skip_nested(char open, char close, std::string_view opening);
  void skip_line_comment();
  void skip_pragma();
  void skip_inactive();
  void skip_string(char quote);
  void directive(size_t begin);

  // scanner.cc
  TokenKind scan();
  TokenKind scan_word();
  std::optional<TokenKind> end_name(size_t begin);
  TokenKind dash(size_t begin);
  TokenKind scan_prefixed(std::string_view prefix);
  TokenKind scan_string(char quote, TokenKind kind);
  TokenKind scan_direct();
  TokenKind scan_number();
  void scan_exponent();
  // Consumes characters of a date or duration; `.`, `:` and `-` only before a digit.
  void scan_time_text(std::string_view joiners);

  // diagram.cc
  void skip_diagram(size_t word, TokenKind kind);

  // punctuation.cc
  TokenKind scan_punctuation();
  TokenKind foreign(TokenKind kind, uint32_t length, const char* fix);
  TokenKind bad_characters();

  char peek(size_t ahead = 0) const {
    return at_ + ahead < text_.size() ? text_[at_ + ahead] : '\0';
  }
  bool at_end() const { return at_ >= text_.size(); }
  TokenKind take(uint32_t length, TokenKind kind) {
    at_ += length;
    return kind;
  }
  base::SourceSpan span(size_t from, size_t to) const {
    return {{base_ + static_cast<uint32_t>(from)}, {base_ + static_cast<uint32_t>(to)}};
  }
  void report(base::DiagnosticCode code, size_t from, size_t to, std::string text,
              std::string fix = {}) {
    diagnostics_.add(code, span(from, to), std::move(text), std::move(fix));
  }

  std::string_view text_;
  uint32_t base_;
  base::Diagnostics& diagnostics_;
  const LexOptions& options_;
  Conditions conditions_;
  TokenList list_;
  size_t at_ = 0;
};

}  // namespace frontend
