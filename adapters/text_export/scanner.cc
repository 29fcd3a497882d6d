#include "adapters/text_export/scanner.h"

#include "adapters/xml/document.h"
#include "base/name_case.h"
#include "frontend/lex/characters.h"

namespace text_export {

using base::same_name;

void Scanner::skip_blanks() {
  while (!at_end() && frontend::is_space(text_[at_])) ++at_;
}

// `(* ... *)`, which may nest. One that does not end is all that follows, and an error.
void Scanner::skip_comment() {
  const uint32_t begin = at_;
  uint32_t depth = 0;
  do {
    if (rest().starts_with("(*") && (nested_ || depth == 0)) {
      ++depth;
      at_ += 2;
    } else if (rest().starts_with("*)")) {
      --depth;
      at_ += 2;
    } else {
      ++at_;
    }
  } while (depth > 0 && !at_end());
  at_ = std::min(at_, size());
  if (depth > 0) open_comment_ = begin;
}

void Scanner::skip_blanks_and_comments() {
  for (skip_blanks(); rest().starts_with("(*"); skip_blanks()) skip_comment();
}

std::string_view Scanner::word() {
  const uint32_t begin = at_;
  if (!at_end() && frontend::is_name_start(text_[at_])) {
    while (!at_end() && frontend::is_name_part(text_[at_])) ++at_;
  }
  return text_.substr(begin, at_ - begin);
}

std::string_view Scanner::next_word() {
  while (!at_end()) {
    if (rest().starts_with("(*")) {
      skip_comment();
      continue;
    }
    if (rest().starts_with("//")) {
      at_ = line_end();
      continue;
    }
    const char c = text_[at_];
    if (c == '\'' || c == '"') {  // a text ends in its row, at the latest
      const uint32_t end = line_end();
      for (++at_; at_ < end && text_[at_] != c; ++at_) at_ += text_[at_] == '$' ? 1 : 0;
      at_ = std::min(at_ + 1, size());
      continue;
    }
    // `16#FF`, `T#5s`, `8x`: no words, and not the names inside of them.
    if (const std::string_view found = word(); !found.empty()) return found;
    ++at_;
    while (frontend::is_digit(c) && !at_end() && frontend::is_name_part(text_[at_])) ++at_;
  }
  return {};
}

bool Scanner::seek_word(std::string_view wanted) {
  for (;;) {
    const std::string_view found = next_word();
    if (found.empty()) return false;
    if (!same_name(found, wanted)) continue;
    at_ -= static_cast<uint32_t>(found.size());
    return true;
  }
}

// The same where texts are no Structured Text: `wanted` begins a line, and no comment of a network
// is around it. A comment is a text in ', which may hold any line.
bool Scanner::seek_line(std::string_view wanted) {
  bool inside = false;
  char last = ' ';  // of the line before
  for (; !at_end(); skip_line()) {
    const std::string_view line = xml::trimmed(text_.substr(at_, line_end() - at_));
    if (line == "_COMMENT" && !inside) {
      inside = true;
    } else if (inside && line == "_END_COMMENT" && last == '\'') {
      inside = false;
    } else if (!inside) {
      const bool whole =
          line.size() <= wanted.size() || !frontend::is_name_part(line[wanted.size()]);
      if (whole && same_name(line.substr(0, wanted.size()), wanted)) {
        skip_blanks();
        return true;
      }
    }
    if (!line.empty()) last = line.back();
  }
  return false;
}

}  // namespace text_export
