#include "frontend/format/text.h"

#include <algorithm>

#include "frontend/lex/characters.h"
#include "frontend/lex/literals.h"
#include "ir/types/types.h"

namespace frontend::formatting {

namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

uint32_t newlines_in(std::string_view part) {
  return static_cast<uint32_t>(std::count(part.begin(), part.end(), '\n'));
}

}  // namespace

Text::Text(const base::SourceMap& sources, uint32_t file, const TokenList& list)
    : text_(sources.text(file)),
      base_(sources.begin(file).offset),
      tokens_(list.tokens),
      mark_(text_.starts_with(kByteOrderMark)) {
  bool ascii = std::all_of(text_.begin(), text_.end(), [](char c) { return (c & 0x80) == 0; });
  plain_ = ascii || is_latin1(text_);
  gaps_.reserve(tokens_.size());
  rows_.reserve(tokens_.size());
  uint32_t from = mark_ ? static_cast<uint32_t>(kByteOrderMark.size()) : 0;
  uint32_t row = 0;
  for (uint32_t i = 0; i < tokens_.size(); ++i) {
    scan_gap(from, begin(i));
    row += newlines_in(text_.substr(from, begin(i) - from));
    rows_.push_back(row);
    from = end(i);
  }
}

void Text::scan_gap(uint32_t from, uint32_t to) {
  Gap gap{static_cast<uint32_t>(pieces_.size()), 0, 0};
  uint32_t newlines = 0;
  uint32_t at = from;
  while (at < to) {
    char c = text_[at];
    if (is_space(c)) {
      newlines += c == '\n';
      ++at;
      continue;
    }
    Piece piece{at, 0, newlines, PieceKind::kForeign};
    piece.end = end_of_piece(at, to, piece.kind);
    at = piece.end;
    // The indentation of the piece belongs to what is copied as it stands.
    if (piece.kind == PieceKind::kForeign) piece.begin = with_indentation(piece.begin);
    newlines = 0;
    pieces_.push_back(piece);
    ++gap.count;
  }
  gap.newlines_after = newlines;
  gaps_.push_back(gap);
}

uint32_t Text::end_of_piece(uint32_t at, uint32_t to, PieceKind& kind) const {
  char c = text_[at];
  char next = at + 1 < to ? text_[at + 1] : '\0';
  uint32_t end = to;
  if (c == '/' && next == '/') {
    kind = PieceKind::kLineComment;
    end = static_cast<uint32_t>(std::min<size_t>(text_.find('\n', at), to));
  } else if ((c == '(' || c == '/') && next == '*') {
    kind = PieceKind::kBlockComment;
    return end_of_block_comment(at, to);
  } else if (c == '{') {
    kind = PieceKind::kPragma;
    return static_cast<uint32_t>(std::min<size_t>(text_.find('}', at), to - 1)) + 1;
  }
  while (is_space(text_[end - 1])) --end;
  return end;
}

uint32_t Text::end_of_block_comment(uint32_t at, uint32_t to) const {
  char open = text_[at];
  char close = open == '(' ? ')' : '/';
  uint32_t depth = 1;
  for (at += 2; at + 1 < to; ++at) {
    if (text_[at] == open && text_[at + 1] == '*') {
      ++depth;
      ++at;
    } else if (text_[at] == '*' && text_[at + 1] == close) {
      ++at;
      if (--depth == 0) return at + 1;
    }
  }
  return to;
}

bool Text::is_word(uint32_t i, std::string_view upper) const {
  return is_name(kind(i)) && ir::same_name(token(i), upper);
}

uint32_t Text::columns(std::string_view part) const {
  if (plain_) return static_cast<uint32_t>(part.size());
  auto begins = [](char c) { return (c & 0xC0) != 0x80; };
  return static_cast<uint32_t>(std::count_if(part.begin(), part.end(), begins));
}

uint32_t Text::with_indentation(uint32_t offset) const {
  uint32_t start = offset;
  while (start != 0 && (text_[start - 1] == ' ' || text_[start - 1] == '\t')) --start;
  return start == 0 || text_[start - 1] == '\n' ? start : offset;
}

uint32_t Text::column_of(uint32_t offset) const {
  uint32_t start = offset;
  while (start != 0 && text_[start - 1] != '\n') --start;
  std::string_view before = text_.substr(start, offset - start);
  if (before.find('\t') != std::string_view::npos) return kUnknownColumn;
  return columns(before) - (start == 0 && mark_ ? 1 : 0);
}

}  // namespace frontend::formatting
