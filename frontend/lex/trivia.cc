#include <algorithm>
#include <cstring>

#include "base/limits.h"
#include "frontend/lex/characters.h"
#include "frontend/lex/scanner.h"

namespace frontend {

using base::DiagnosticCode;

void Scanner::skip_trivia() {
  for (;;) {
    if (!conditions_.active()) skip_inactive();
    while (at_ < text_.size() && is_space(text_[at_])) ++at_;
    char c = peek();
    if (c == '{') {
      skip_pragma();
    } else if ((c != '(' && c != '/') || !skip_comment()) {
      return;
    }
  }
}

bool Scanner::skip_comment() {
  char c = peek();
  char next = peek(1);
  if (c == '(' && next == '*') {
    skip_nested('(', ')', "(*");
  } else if (c == '/' && next == '*') {
    skip_nested('/', '/', "/*");
  } else if (c == '/' && next == '/') {
    skip_line_comment();
  } else {
    return false;
  }
  return true;
}

// Each kind nests in itself (IEC 61131-3 6.1.5); depth is a counter, not recursion.
void Scanner::skip_nested(char open, char close, std::string_view opening) {
  size_t begin = at_;
  uint32_t depth = 1;
  at_ += 2;
  while (at_ + 1 < text_.size()) {
    if (text_[at_] == open && text_[at_ + 1] == '*') {
      if (++depth == base::kMaxNesting + 1) {
        report(DiagnosticCode::kTooDeep, at_, at_ + 2,
               "comments are nested more than " + std::to_string(base::kMaxNesting) + " deep");
      }
      at_ += 2;
    } else if (text_[at_] == '*' && text_[at_ + 1] == close) {
      at_ += 2;
      if (--depth == 0) return;
    } else {
      ++at_;
    }
  }
  at_ = text_.size();
  std::string closing = std::string("*") + close;
  report(DiagnosticCode::kUnterminatedComment, begin, begin + 2,
         "this comment is not closed; everything after it was skipped",
         depth == 1 ? "close it with `" + closing + '`'
                    : "comments nest: " + std::to_string(depth) + " times `" + closing +
                          "` are missing for `" + std::string(opening) + '`');
}

void Scanner::skip_line_comment() {
  const void* newline = std::memchr(text_.data() + at_, '\n', text_.size() - at_);
  at_ = newline == nullptr ? text_.size()
                           : static_cast<size_t>(static_cast<const char*>(newline) - text_.data());
}

void Scanner::skip_pragma() {
  size_t begin = at_;
  size_t end = text_.find('}', at_);
  if (end == std::string_view::npos) {
    at_ = text_.size();
    report(DiagnosticCode::kUnterminatedPragma, begin, begin + 1,
           "this pragma is not closed; everything after it was skipped", "close it with `}`");
    return;
  }
  at_ = end + 1;
  bool outer = conditions_.active();
  if (options_.conditional) directive(begin);
  if (outer) list_.pragmas.push_back(span(begin, at_));
}

void Scanner::directive(size_t begin) {
  std::string_view inside = text_.substr(begin + 1, at_ - begin - 2);
  auto problem = conditions_.take(inside, span(begin, at_));
  if (problem) report(problem->code, begin, at_, problem->text, problem->fix);
}

// Text that a condition leaves out: only comments, strings and pragmas are looked at,
// so that a `{END_IF}` inside of them does not count.
void Scanner::skip_inactive() {
  while (!at_end() && !conditions_.active()) {
    char c = peek();
    if (c == '{') {
      skip_pragma();
    } else if (c == '\'' || c == '"') {
      skip_string(c);
    } else if ((c != '(' && c != '/') || !skip_comment()) {
      ++at_;
    }
  }
}

void Scanner::skip_string(char quote) {
  ++at_;
  while (!at_end() && peek() != quote && peek() != '\n') at_ += peek() == '$' ? 2 : 1;
  at_ = std::min(at_ + 1, text_.size());
}

}  // namespace frontend
