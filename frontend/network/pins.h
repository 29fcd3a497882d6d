// What the text forms of ladder and FBD share: a cursor over the tokens of one element, and
// the arguments of a box.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/lex/lexer.h"
#include "frontend/network/network.h"

namespace frontend::network {

// A position in the tokens of a text that begins at `begin` of a SourceMap. What a message is
// about is said once: after a report the rest of the element says nothing.
class Cursor {
 public:
  Cursor(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics);

  TokenKind kind(size_t ahead = 0) const { return token(ahead).kind; }
  const Token& token(size_t ahead = 0) const {
    return tokens_[at_ + ahead < tokens_.size() ? at_ + ahead : tokens_.size() - 1];
  }
  const Token& token_before() const { return tokens_[at_ == 0 ? 0 : at_ - 1]; }
  std::string_view text(const Token& token) const {
    return text_.substr(token.begin - begin_, token.length);
  }
  bool is_word(std::string_view word, size_t ahead = 0) const;
  bool at_end() const { return kind() == TokenKind::kEnd; }
  void take() { at_ += at_end() ? 0 : 1; }
  bool accept(TokenKind wanted);
  size_t place() const { return at_; }
  void go_to(size_t place) { at_ = place; }

  Text name();  // takes A.B.C
  // JMP and a label, or a reserved word, which label() refuses.
  bool at_jump() const { return is_word("JMP") && (is_name(kind(1)) || is_keyword(kind(1))); }
  Text label();
  // Takes tokens up to one of `,` `=>` `closing` `;` or a `:=` outside of brackets, or the end.
  Text operand(TokenKind closing);
  Text text_from(size_t place) const;  // what the tokens from there on, up to here, are

  base::SourceSpan span_from(size_t place) const;
  void report(base::DiagnosticCode code, base::SourceSpan span, std::string text,
              std::string fix = {});
  // "`x`", or "the end" of the element.
  std::string found() const;
  bool good() const { return good_; }
  void forget() { good_ = true; }

 private:
  std::string_view text_;
  uint32_t begin_;
  base::Diagnostics& diagnostics_;
  std::vector<Token> tokens_;
  size_t at_ = 0;
  bool good_ = true;
};

// An operand with what stands for the modifier of its pin: `NOT x`, `[/ x]`, `[P x]`, `[N x]`.
struct PinValue {
  Modifier modifier = Modifier::kNone;
  Text operand;
};
PinValue read_value(Cursor& cursor, TokenKind closing);

// `P x`, `N x`, `/ x` and, where `set`, `S x` and `R x`, as contacts and coils begin.
Modifier read_modifier(Cursor& cursor, bool set);

struct Pin {
  Text name;            // empty: by position
  bool output = false;  // name => value
  bool power = false;   // the value is `_`
  PinValue value;
  base::SourceSpan span;
};
// Arguments up to `closing`, which stays.
std::vector<Pin> read_pins(Cursor& cursor, TokenKind closing);

}  // namespace frontend::network
