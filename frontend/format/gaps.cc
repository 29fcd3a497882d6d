// What stands between two tokens of one line.
#include "frontend/format/layout.h"

namespace frontend::formatting {

// Pieces of the gap that stand in the row of the token in front of it.
uint32_t Layout::trailing_pieces(const Gap& gap) const {
  uint32_t n = 0;
  while (n < gap.count && text_.piece(gap.first + n).newlines_before == 0) ++n;
  return n;
}

// Columns and breaks of the gap in front of token `i`. A comment of several lines counts with its
// first one, which stays what it is when the others move.
void Layout::measure_gap(uint32_t i) {
  const Gap& gap = text_.gap(i);
  uint32_t k = i - first_;
  uint32_t trailing = trailing_pieces(gap);
  bool ends_row = trailing < gap.count || gap.newlines_after != 0;
  // Does a comment end a row, or stand in one of its own?
  bool breaks = trailing != 0 && ends_row;
  for (uint32_t n = 0; n < gap.count; ++n) {
    const Piece& piece = text_.piece(gap.first + n);
    bool last = n + 1 == gap.count;
    uint32_t after = last ? gap.newlines_after : text_.piece(gap.first + n + 1).newlines_before;
    breaks = breaks || after != 0 || piece.kind == PieceKind::kForeign ||
             text_.piece_text(piece).find('\n') != std::string_view::npos;
    std::string_view line = text_.piece_text(piece).substr(0, text_.piece_text(piece).find('\n'));
    before_[k] += text_.columns(line) + 1;
  }
  uint32_t open = i - 1;
  if (text_.row(i) != text_.row(open) && partner_[k - 1] > i &&
      group_kind(text_, open, partner_[k - 1], first_) == GroupKind::kList) {
    breaks = true;
  }
  if (gap.count != 0 || blank_[k]) ++before_[k];
  forced_sum_[k + 1] += breaks ? 1 : 0;
}

void Layout::write_gap(uint32_t i) {
  const Gap& gap = text_.gap(i);
  uint32_t last = gap.first + gap.count;
  uint32_t next = gap.first + trailing_pieces(gap);
  bool ends_row = next < last || gap.newlines_after != 0;
  uint32_t inline_from = last;  // pieces from here on stand in the token's row
  if (ends_row) {
    for (uint32_t p = gap.first; p < next; ++p) put_trailing(text_.piece(p));
    if (next != gap.first) need_break();
    if (gap.newlines_after == 0) {
      while (inline_from > next && text_.piece(inline_from - 1).kind != PieceKind::kForeign) {
        if (text_.piece(--inline_from).newlines_before != 0) break;
      }
    }
    own_rows(next, inline_from);
  } else {
    inline_from = gap.first;
  }
  uint32_t newlines =
      inline_from < last ? text_.piece(inline_from).newlines_before : gap.newlines_after;
  if (break_wanted_) {
    take_break(newlines > 1);
  } else if (blank_[i - first_] && inline_from == last) {
    put_blank();
  }
  for (uint32_t p = inline_from; p < last; ++p) {
    put_blank();
    put_piece(text_.piece(p));
    if (p + 1 == last) put_blank();
  }
}

// Pieces [from, to), each source row as a row of its own.
void Layout::own_rows(uint32_t from, uint32_t to) {
  for (uint32_t p = from; p < to; ++p) {
    const Piece& piece = text_.piece(p);
    need_break();
    bool begins = p == from || piece.newlines_before != 0 || piece.kind == PieceKind::kForeign;
    if (begins) {
      bool foreign = piece.kind == PieceKind::kForeign;
      open_row(comment_indent_, foreign ? RowKind::kVerbatim : RowKind::kComment,
               blank_allowed_ && piece.newlines_before > 1);
      row().source_column = text_.column_of(piece.begin);
    } else {
      put_blank();
    }
    put_piece(piece);
  }
}

// A comment asks for a break that the layout did not want.
void Layout::need_break() {
  if (!break_wanted_) request_break(continuation_, continuation_, false);
}

void Layout::take_break(bool blank) {
  open_row(break_indent_, RowKind::kCode, blank_allowed_ && blank);
  break_wanted_ = false;
}

// Without blanks at the ends of its lines.
void Layout::put_piece(const Piece& piece) {
  std::string_view all = text_.piece_text(piece);
  if (piece.kind == PieceKind::kForeign) return put(all);
  for (;;) {
    size_t newline = all.find('\n');
    std::string_view part = all.substr(0, newline);
    while (!part.empty() && (part.back() == ' ' || part.back() == '\t' || part.back() == '\r')) {
      part.remove_suffix(1);
    }
    put(part);
    if (newline == std::string_view::npos) return;
    put("\n");
    all.remove_prefix(newline + 1);
  }
}

void Layout::put_trailing(const Piece& piece) {
  Row& behind = row();
  uint32_t width = behind.width;
  uint32_t end = behind.end;
  bool first = behind.comment == end;
  if (first) behind.source_column = text_.column_of(piece.begin);
  if (!first) rows_.buffer += ' ';
  put_piece(piece);
  behind.comment = static_cast<uint32_t>(rows_.buffer.size());
  behind.end = end;
  behind.width = width;
}

}  // namespace frontend::formatting
