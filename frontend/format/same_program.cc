#include "frontend/format/same_program.h"

#include "frontend/format/diagrams.h"
#include "frontend/format/spacing.h"
#include "frontend/format/text.h"
#include "frontend/lex/characters.h"
#include "ir/types/types.h"

namespace frontend::formatting {

namespace {

// Equal but for white space at the beginnings and ends of lines.
bool same_piece(std::string_view a, std::string_view b) {
  size_t i = 0;
  size_t j = 0;
  for (;;) {
    size_t skipped_a = i;
    size_t skipped_b = j;
    while (skipped_a < a.size() && is_space(a[skipped_a])) ++skipped_a;
    while (skipped_b < b.size() && is_space(b[skipped_b])) ++skipped_b;
    bool break_a = a.substr(i, skipped_a - i).find('\n') != std::string_view::npos;
    bool break_b = b.substr(j, skipped_b - j).find('\n') != std::string_view::npos;
    bool end_a = skipped_a == a.size();
    bool end_b = skipped_b == b.size();
    if (end_a || end_b) return end_a == end_b;
    if (break_a != break_b) return false;
    if (!break_a && skipped_a - i != skipped_b - j) return false;
    if (a[skipped_a] != b[skipped_b]) return false;
    i = skipped_a + 1;
    j = skipped_b + 1;
  }
}

// A keyword may change its case, nothing else may change anything.
bool same_token(const Text& a, const Text& b, uint32_t i) {
  if (a.kind(i) != b.kind(i)) return false;
  if (is_set_assignment(a, i) != is_set_assignment(b, i)) return false;
  if (a.token(i) == b.token(i)) return true;
  return (is_keyword(a.kind(i)) || is_name(a.kind(i))) && ir::same_name(a.token(i), b.token(i));
}

// Do two gaps in front of the same token have the same drawing?
bool same_drawing(const Text& a, const Text& b, uint32_t i) {
  if (i == 0 || !ends_diagram(a.kind(i - 1), a.kind(i))) return false;
  auto between = [i](const Text& text) {
    return text.text().substr(text.end(i - 1), text.begin(i) - text.end(i - 1));
  };
  return same_diagram(a.kind(i - 1), between(a), between(b));
}

bool same_gap(const Text& a, const Text& b, uint32_t i) {
  if (same_drawing(a, b, i)) return true;
  if (a.gap(i).count != b.gap(i).count) return false;
  for (uint32_t p = 0; p < a.gap(i).count; ++p) {
    const Piece& piece_a = a.piece(a.gap(i).first + p);
    const Piece& piece_b = b.piece(b.gap(i).first + p);
    if (piece_a.kind != piece_b.kind) return false;
    if (!same_piece(a.piece_text(piece_a), b.piece_text(piece_b))) return false;
  }
  return true;
}

}  // namespace

base::Status same_program(const base::SourceMap& before, uint32_t before_file,
                          const base::SourceMap& after, uint32_t after_file) {
  base::Diagnostics before_errors;
  base::Diagnostics after_errors;
  TokenList before_tokens = lex(before, before_file, before_errors, LexOptions::all_text());
  TokenList after_tokens = lex(after, after_file, after_errors, LexOptions::all_text());
  Text a(before, before_file, before_tokens);
  Text b(after, after_file, after_tokens);
  uint32_t count = std::max(a.token_count(), b.token_count());
  for (uint32_t i = 0; i < count; ++i) {
    bool both = i < a.token_count() && i < b.token_count();
    if (both && same_token(a, b, i) && same_gap(a, b, i)) continue;
    uint32_t place = i < a.token_count() ? i : a.token_count() - 1;
    base::SourceLocation at = before.locate(before_tokens.tokens[place].span().begin);
    return base::Error{base::Refusal::kInternal,
                       std::string(at.file) + ":" + std::to_string(at.line) + ":" +
                           std::to_string(at.column) +
                           ": formatting would have changed the program here; the text was left as "
                           "it is"};
  }
  return base::Ok{};
}

}  // namespace frontend::formatting
