#include "frontend/lex/scanner.h"

#include "base/diagnostics_render.h"
#include "base/limits.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/directions.h"
#include "frontend/lex/keywords.h"
#include "frontend/lex/literals.h"
#include "ir/types/types.h"
#include "ir/types/utf.h"

namespace frontend {

using base::DiagnosticCode;

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
// Bytes per token in ordinary sources, comments and blanks included, rounded down.
constexpr size_t kBytesPerToken = 5;

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  for (std::string_view candidate : names) {
    if (ir::same_name(name, candidate)) return true;
  }
  return false;
}

}  // namespace

TokenList lex(const base::SourceMap& sources, uint32_t file, base::Diagnostics& diagnostics,
              const LexOptions& options) {
  TokenList list =
      Scanner(sources.text(file), sources.begin(file).offset, diagnostics, options).run();
  if (!list.latin1) warn_of_directions(sources.text(file), sources.begin(file).offset, diagnostics);
  return list;
}

TokenList lex(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics) {
  const LexOptions all = LexOptions::all_text();
  return Scanner(text, begin.offset, diagnostics, all).run();
}

TokenList Scanner::run() {
  list_.latin1 = is_latin1(text_);
  list_.tokens.reserve(text_.size() / kBytesPerToken + 16);
  if (text_.starts_with(kByteOrderMark)) at_ = kByteOrderMark.size();
  for (;;) {
    skip_trivia();
    size_t begin = at_;
    if (at_end()) break;
    TokenKind kind = scan();
    if (kind == TokenKind::kEnd) continue;  // nothing usable, reported
    list_.tokens.push_back(
        {base_ + static_cast<uint32_t>(begin), static_cast<uint32_t>(at_ - begin), kind});
    if (kind == TokenKind::kLadder || kind == TokenKind::kFbd) skip_diagram(begin, kind);
  }
  list_.tokens.push_back({base_ + static_cast<uint32_t>(text_.size()), 0, TokenKind::kEnd});
  for (base::SourceSpan open : conditions_.open_spans()) {
    diagnostics_.add(DiagnosticCode::kOpenCondition, open, "this {IF ...} has no {END_IF}",
                     "write {END_IF} after the last line that depends on it");
  }
  return std::move(list_);
}

TokenKind Scanner::scan() {
  char c = peek();
  if (is_name_start(c)) return scan_word();
  if (is_digit(c)) return scan_number();
  if (c == '\'') return scan_string(c, TokenKind::kString);
  if (c == '"') return scan_string(c, TokenKind::kWideString);
  if (c == '%' && is_name_start(peek(1))) return scan_direct();
  return scan_punctuation();
}

TokenKind Scanner::scan_word() {
  size_t start = at_;
  const char* begin = text_.data() + at_;
  const char* end = begin;
  uint8_t high = 0;
  while (end != text_.data() + text_.size() && is_name_part(*end)) {
    high |= static_cast<uint8_t>(*end++);
  }
  at_ += static_cast<size_t>(end - begin);
  if (high >= 0x80) {
    if (auto other = end_name(start)) return *other;
  }
  std::string_view word = text_.substr(start, at_ - start);
  if (word.size() > base::kMaxIdentifier) {
    report(DiagnosticCode::kNameTooLong, at_ - word.size(), at_,
           "this name has " + std::to_string(word.size()) + " bytes, the limit is " +
               std::to_string(base::kMaxIdentifier));
  }
  if (peek() == '#') return scan_prefixed(word);
  return keyword(word);
}

// A name ends in front of a character that no name has. Where that character comes first,
// it is reported, and what is left of it comes back: kEnd for nothing.
std::optional<TokenKind> Scanner::end_name(size_t begin) {
  size_t end = at_;
  for (at_ = begin; at_ < end;) {
    ir::Utf8Character character{static_cast<uint8_t>(text_[at_]), 1};
    if (character.code >= 0x80 && !list_.latin1) character = ir::read_utf8(text_.substr(at_));
    // Files that are not UTF-8 may be Windows-1252 or mixed: only their hard blank is refused.
    bool in_name = list_.latin1 ? character.code != 0xA0 : is_name_character(character.code);
    if (character.code >= 0x80 && !in_name) {
      if (at_ > begin) return std::nullopt;
      at_ += character.bytes;
      if (is_dash(character.code)) return dash(begin);
      report(DiagnosticCode::kBadCharacter, begin, at_,
             '`' + base::printable(text_.substr(begin, at_ - begin)) +
                 "` has no meaning in Structured Text outside comments and strings",
             "remove it");
      return TokenKind::kEnd;
    }
    at_ += character.bytes;
  }
  return std::nullopt;
}

// What word processors make of a minus sign is understood as one.
TokenKind Scanner::dash(size_t begin) {
  report(DiagnosticCode::kForeignOperator, begin, at_,
         '`' + std::string(text_.substr(begin, at_ - begin)) + "` is a dash, not a minus sign",
         "write `-`");
  return TokenKind::kMinus;
}

// `T#5s` is one token, `INT#5` two: the type prefix, and a literal or name after
// it. A prefix such as `T` or `D` without a digit after it may be an enumeration's.
TokenKind Scanner::scan_prefixed(std::string_view prefix) {
  ++at_;
  bool sign = peek() == '-' || peek() == '+';
  if (!is_digit(peek(sign ? 1 : 0))) return TokenKind::kTypePrefix;
  if (is_one_of(prefix, {"T", "TIME", "LT", "LTIME"})) {
    at_ += sign ? 1 : 0;
    scan_time_text(".");
    return TokenKind::kDuration;
  }
  if (sign) return TokenKind::kTypePrefix;
  if (is_one_of(prefix, {"D", "DATE", "LD", "LDATE"})) {
    scan_time_text("-");
    return TokenKind::kDate;
  }
  if (is_one_of(prefix, {"TOD", "TIME_OF_DAY", "LTOD", "LTIME_OF_DAY"})) {
    scan_time_text(".:");
    return TokenKind::kDate;
  }
  if (is_one_of(prefix, {"DT", "DATE_AND_TIME", "LDT", "LDATE_AND_TIME"})) {
    scan_time_text(".:-");
    return TokenKind::kDate;
  }
  return TokenKind::kTypePrefix;
}

void Scanner::scan_time_text(std::string_view joiners) {
  while (is_name_part(peek()) ||
         (joiners.find(peek()) != std::string_view::npos && is_digit(peek(1)))) {
    ++at_;
  }
}

TokenKind Scanner::scan_string(char quote, TokenKind kind) {
  size_t begin = at_++;
  while (!at_end() && peek() != quote && peek() != '\n') {
    bool escaped = peek() == '$' && peek(1) != '\n' && at_ + 1 < text_.size();
    at_ += escaped ? 2 : 1;
  }
  if (peek() == quote) return take(1, kind);
  if (at_ > begin + 1 && text_[at_ - 1] == '\r') --at_;
  report(DiagnosticCode::kUnterminatedString, begin, at_,
         std::string("this string has no closing ") + quote + " on its line",
         std::string("close it with ") + quote + "; write a quote inside it as $" + quote);
  return kind;
}

TokenKind Scanner::scan_direct() {
  ++at_;
  bool digits = false;
  for (; is_name_part(peek()) || (peek() == '.' && is_digit(peek(1))); ++at_) {
    digits = digits || is_digit(peek());
  }
  if (!digits && peek() == '*') ++at_;  // %I* is open, %IW0*2 a product
  return TokenKind::kDirect;
}

// Takes every byte that could belong to the number, so that `12abc` is one
// malformed number and not two tokens.
TokenKind Scanner::scan_number() {
  while (is_digit(peek()) || peek() == '_') ++at_;
  if (peek() == '#') {
    ++at_;
    while (is_name_part(peek())) ++at_;
    return TokenKind::kInteger;
  }
  TokenKind kind = TokenKind::kInteger;
  // `a.1.2` and `1..5` are not reals; a bit number after a dot never has a fraction.
  bool after_dot = !list_.tokens.empty() && list_.tokens.back().kind == TokenKind::kDot;
  if (!after_dot && peek() == '.' && is_digit(peek(1))) {
    ++at_;
    while (is_digit(peek()) || peek() == '_') ++at_;
    kind = TokenKind::kReal;
  }
  if (peek() == 'e' || peek() == 'E') {
    kind = TokenKind::kReal;
    scan_exponent();
  }
  while (is_name_part(peek())) ++at_;
  return kind;
}

void Scanner::scan_exponent() {
  ++at_;
  if ((peek() == '-' || peek() == '+') && is_digit(peek(1))) ++at_;
  while (is_digit(peek()) || peek() == '_') ++at_;
}

}  // namespace frontend
