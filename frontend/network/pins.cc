#include "frontend/network/pins.h"

#include "frontend/network/comments.h"
#include "ir/types/types.h"

namespace frontend::network {

Cursor::Cursor(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics)
    : text_(text), begin_(begin.valid() ? begin.offset : 0), diagnostics_(diagnostics) {
  tokens_ = lex(text, base::SourcePos{begin_}, diagnostics).tokens;
}

bool Cursor::is_word(std::string_view word, size_t ahead) const {
  return is_name(kind(ahead)) && ir::same_name(text(token(ahead)), word);
}

bool Cursor::accept(TokenKind wanted) {
  if (kind() != wanted) return false;
  take();
  return true;
}

base::SourceSpan Cursor::span_from(size_t place) const {
  const Token& first = tokens_[place];
  if (at_ == place) return first.span();
  const Token& last = tokens_[at_ - 1];
  return {{first.begin}, {last.begin + last.length}};
}

Text Cursor::text_from(size_t place) const {
  if (place == at_) return {{}, tokens_[place].span()};
  Text out;
  out.span = span_from(place);
  out.text =
      text_.substr(out.span.begin.offset - begin_, out.span.end.offset - out.span.begin.offset);
  bool plain = out.text.find_first_of("\n\r\t") == std::string::npos;
  if (plain && comments_in(out.text).empty()) return out;  // readers keep comments elsewhere
  out.text.clear();
  for (size_t i = place; i < at_; ++i) {
    bool apart = i > place && tokens_[i].begin != tokens_[i - 1].begin + tokens_[i - 1].length;
    if (apart) out.text += ' ';
    out.text += text(tokens_[i]);
  }
  return out;
}

Text Cursor::name() {
  size_t begin = at_;
  bool function = kind() == TokenKind::kAnd || kind() == TokenKind::kOr ||
                  kind() == TokenKind::kXor || kind() == TokenKind::kNot ||
                  kind() == TokenKind::kMod;
  if (is_name(kind()) || (function && kind(1) == TokenKind::kLeftParen)) take();
  while (at_ != begin && kind() == TokenKind::kDot && is_name(kind(1))) at_ += 2;
  return text_from(begin);
}

Text Cursor::label() {
  if (is_keyword(kind())) {
    report(base::DiagnosticCode::kReservedWord, token().span(),
           found() + " is a reserved word and cannot name a label", "choose another name");
    take();
  }
  return name();
}

Text Cursor::operand(TokenKind closing) {
  size_t begin = at_;
  uint32_t depth = 0;
  for (; !at_end(); take()) {
    TokenKind k = kind();
    bool opens = k == TokenKind::kLeftParen || k == TokenKind::kLeftBracket;
    bool closes = k == TokenKind::kRightParen || k == TokenKind::kRightBracket;
    bool ends = k == closing || k == TokenKind::kComma || k == TokenKind::kSemicolon ||
                k == TokenKind::kArrow || k == TokenKind::kAssign;
    if (depth == 0 && (ends || closes)) break;
    if (k == TokenKind::kSemicolon) break;
    depth += opens ? 1 : 0;
    depth -= closes ? 1 : 0;
  }
  return text_from(begin);
}

void Cursor::report(base::DiagnosticCode code, base::SourceSpan span, std::string text,
                    std::string fix) {
  if (good_) diagnostics_.add(code, span, std::move(text), std::move(fix));
  good_ = false;
}

std::string Cursor::found() const {
  return at_end() ? "the end" : '`' + std::string(text(token())) + '`';
}

// `P x` are two names side by side, which an expression never has; `P` alone is a variable.
Modifier read_modifier(Cursor& cursor, bool set) {
  if (cursor.accept(TokenKind::kSlash)) return Modifier::kNegated;
  TokenKind next = cursor.kind(1);
  if (!is_name(next) && next != TokenKind::kDirect && next != TokenKind::kLeftParen &&
      next != TokenKind::kNot) {
    return Modifier::kNone;
  }
  struct Word {
    const char* word;
    Modifier modifier;
    bool set;
  };
  static constexpr Word kWords[] = {{"P", Modifier::kRising, false},
                                    {"N", Modifier::kFalling, false},
                                    {"S", Modifier::kSet, true},
                                    {"R", Modifier::kReset, true}};
  bool call = next == TokenKind::kLeftParen;
  for (const Word& word : kWords) {
    if (!cursor.is_word(word.word) || call || (word.set && !set)) continue;
    cursor.take();
    return word.modifier;
  }
  return Modifier::kNone;
}

PinValue read_value(Cursor& cursor, TokenKind closing) {
  PinValue out;
  size_t begin = cursor.place();
  if (cursor.accept(TokenKind::kLeftBracket)) {
    out.modifier = read_modifier(cursor, false);
    out.operand = cursor.operand(TokenKind::kRightBracket);
    if (out.modifier != Modifier::kNone && cursor.accept(TokenKind::kRightBracket)) return out;
    out.modifier = Modifier::kNone;
    cursor.go_to(begin);
  }
  if (cursor.kind() == TokenKind::kNot) {
    cursor.take();
    size_t behind = cursor.place();
    out.operand = cursor.operand(closing);
    size_t end = cursor.place();
    cursor.go_to(behind);
    cursor.name();
    if (cursor.place() == end && end != behind) {
      out.modifier = Modifier::kNegated;
      return out;
    }
    cursor.go_to(begin);
  }
  out.operand = cursor.operand(closing);
  return out;
}

namespace {

Pin read_pin(Cursor& cursor, TokenKind closing) {
  Pin pin;
  size_t begin = cursor.place();
  if (is_name(cursor.kind()) &&
      (cursor.kind(1) == TokenKind::kAssign || cursor.kind(1) == TokenKind::kArrow)) {
    cursor.take();
    pin.name = cursor.text_from(begin);
    pin.output = cursor.kind() == TokenKind::kArrow;
    cursor.take();
  } else if (cursor.accept(TokenKind::kArrow)) {
    pin.output = true;
  }
  bool alone = cursor.kind(1) == TokenKind::kComma || cursor.kind(1) == TokenKind::kEnd ||
               cursor.kind(1) == closing;
  if (cursor.is_word("_") && alone) {
    pin.power = true;
    cursor.take();
  } else {
    pin.value = read_value(cursor, closing);
  }
  pin.span = cursor.span_from(begin);
  return pin;
}

}  // namespace

std::vector<Pin> read_pins(Cursor& cursor, TokenKind closing) {
  std::vector<Pin> out;
  while (cursor.good() && !cursor.at_end() && cursor.kind() != closing) {
    size_t begin = cursor.place();
    out.push_back(read_pin(cursor, closing));
    if (cursor.kind() == closing || cursor.at_end()) break;
    bool empty = cursor.place() == begin;
    if (cursor.accept(TokenKind::kComma) && !empty) continue;
    cursor.report(base::DiagnosticCode::kExpected, cursor.token().span(),
                  "expected `,` or the end of the arguments, found " + cursor.found(),
                  "separate arguments by commas");
  }
  return out;
}

}  // namespace frontend::network
