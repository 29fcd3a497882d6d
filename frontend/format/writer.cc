#include "frontend/format/writer.h"

#include "frontend/format/diagrams.h"
#include "frontend/lex/characters.h"

namespace frontend::formatting {

Rows Writer::run() {
  find_regions();
  rows_.buffer.reserve(text_.text().size() + 64);
  rows_.rows.reserve(outline_.lines.size() + text_.pieces().size());
  for (uint32_t index = 0; index < outline_.lines.size(); ++index) {
    uint32_t last = try_joined(index);
    write_line(index);
    index = last;
  }
  return std::move(rows_);
}

// Decides whether the line at `index` takes the following ones into its row, as a section of
// variables or a short branch that stood in one row; returns the last one that it takes.
uint32_t Writer::try_joined(uint32_t index) {
  Line joined = outline_.lines[index];
  uint32_t last = index;
  // Something stands in front of it in its row: long enough without more.
  const Gap& gap = text_.gap(joined.first);
  if (gap.count != 0 && gap.newlines_after == 0) return index;
  if (joined.row_end != 0) {
    last = joined.row_end;
    joined.kind = LineKind::kDeclaration;
    joined.block = 0;
  } else if (joins_statement(index)) {
    last = index + 1;
    joined.kind = LineKind::kStatement;
    joined.label_end = joined.end;
  }
  if (last == index) return index;
  joined.end = outline_.lines[last].end;
  joined.opens = false;
  layout_.measure(joined);
  if (!layout_.fits_flat(joined, 0)) return index;
  outline_.lines[index] = joined;
  return last;
}

// A label and the only statement of its branch.
bool Writer::joins_statement(uint32_t index) const {
  if (index + 2 >= outline_.lines.size()) return false;
  const Line& label = outline_.lines[index];
  const Line& statement = outline_.lines[index + 1];
  const Line& next = outline_.lines[index + 2];
  return label.kind == LineKind::kLabel && statement.kind == LineKind::kStatement &&
         next.level < statement.level && statement.level == label.level + 1 &&
         text_.row(label.end - 1) == text_.row(statement.first) &&
         text_.row(statement.first) == text_.row(statement.end - 1);
}

void Writer::write_line(uint32_t index) {
  const Line& line = outline_.lines[index];
  boundary(line);
  if (in_region(text_.begin(line.first))) return;
  bool sentinel = text_.kind(line.first) == TokenKind::kEnd;
  if (sentinel && prefix_.empty()) return;
  const Gap& gap = text_.gap(line.first);
  uint32_t newlines = prefix_.empty() ? gap.newlines_after : prefix_.front().newlines_before;
  open_line(line, newlines);
  for (const Piece& piece : prefix_) {
    layout_.put_blank();
    layout_.put_piece(piece);
  }
  if (sentinel) return;
  if (!prefix_.empty()) layout_.put_blank();
  if (line.kind == LineKind::kVerbatim) {
    uint32_t begin = text_.with_indentation(text_.begin(line.first));
    layout_.put(text_.text().substr(begin, text_.end(line.end - 1) - begin));
    layout_.row().kind = RowKind::kVerbatim;
  } else {
    size_t first_row = rows_.rows.size() - 1;
    layout_.measure(line);
    layout_.write(line);
    // What stands in front of it would push its neighbours to the right.
    if (!prefix_.empty()) {
      for (uint32_t& mark : rows_.rows[first_row].mark) mark = 0;
    }
  }
  before_ = &line;
  fresh_ = true;
}

bool Writer::blank(uint32_t newlines) const {
  if (fresh_ && before_ != nullptr && before_->opens) return false;
  return newlines > 1;
}

void Writer::open_line(const Line& line, uint32_t newlines) {
  bool separate = fresh_ && before_ != nullptr && before_->ends_pou;
  bool empty_before = (separate || blank(newlines)) && !line.closes;
  layout_.open_row(layout_.columns_of(line.level), RowKind::kCode, empty_before);
}

// What stands in front of the first token of `line`: comments after the line before, comments of
// their own, and what stays in the row of the token.
void Writer::boundary(const Line& line) {
  prefix_.clear();
  if (write_diagram(line)) return;
  const Gap& gap = text_.gap(line.first);
  uint32_t last = gap.first + gap.count;
  uint32_t next = trailing(gap);
  uint32_t own_end = last;
  if (gap.newlines_after == 0 && text_.kind(line.first) != TokenKind::kEnd) {
    while (own_end > next && text_.piece(own_end - 1).kind != PieceKind::kForeign) {
      --own_end;
      if (text_.piece(own_end).newlines_before != 0) break;
    }
  }
  own_rows(line, next, own_end);
  if (!has_region_before(text_.begin(line.first))) {
    for (uint32_t p = own_end; p < last; ++p) {
      if (!in_region(text_.piece(p).begin)) prefix_.push_back(text_.piece(p));
    }
    return;
  }
  // A region takes the row of the token.
  own_rows(line, own_end, last);
  while (has_region_before(text_.begin(line.first))) write_region();
}

// What stands between LADDER or FBD and its end, when `line` is that end.
bool Writer::write_diagram(const Line& line) {
  if (line.first == 0) return false;
  TokenKind head = text_.kind(line.first - 1);
  if (!ends_diagram(head, text_.kind(line.first))) return false;
  uint32_t begin = text_.end(line.first - 1);
  uint32_t end = text_.begin(line.first);
  if (in_region(begin) || has_region_before(end)) return false;
  std::string_view text = text_.text().substr(begin, end - begin);
  std::optional<std::string> rows = drawn(head, text, layout_.columns_of(line.level + 1), options_);
  fresh_ = false;
  if (rows) {
    if (rows->empty()) return true;
    layout_.open_row(0, RowKind::kVerbatim, false);
    layout_.put(*rows);
    return true;
  }
  // As it is, from the first row to the last one.
  bool one_line = text.find('\n') == std::string_view::npos;
  while (!text.empty() && (one_line ? is_space(text.back()) : text.back() != '\n')) {
    text.remove_suffix(1);
  }
  size_t first = text.find_first_not_of(" \t\r");
  bool in_row = first != std::string_view::npos && text[first] != '\n';
  if (!in_row) text.remove_prefix(first == std::string_view::npos ? text.size() : first + 1);
  if (text.empty()) return true;
  layout_.open_row(0, in_row ? RowKind::kJoined : RowKind::kVerbatim, false);
  layout_.put(text);
  return true;
}

// Comments in the row of the line before are its own; a pragma there belongs to what follows,
// unless the row ends with it. Returns the first piece that is left.
uint32_t Writer::trailing(const Gap& gap) {
  uint32_t last = gap.first + gap.count;
  uint32_t next = gap.first;
  while (next < last && text_.piece(next).newlines_before == 0) ++next;
  bool ends_row = next < last || gap.newlines_after != 0;
  if (before_ == nullptr || rows_.rows.empty()) return gap.first;
  for (uint32_t p = gap.first; p < next; ++p) {
    const Piece& piece = text_.piece(p);
    bool follows = piece.kind == PieceKind::kPragma && !ends_row;
    if (follows || piece.kind == PieceKind::kForeign || in_region(piece.begin)) return p;
    layout_.put_trailing(piece);
    if (has_region_before(piece.end)) write_region();
  }
  return next;
}

void Writer::own_rows(const Line& line, uint32_t from, uint32_t to) {
  for (uint32_t p = from; p < to; ++p) {
    const Piece& piece = text_.piece(p);
    if (in_region(piece.begin)) continue;
    bool foreign = piece.kind == PieceKind::kForeign;
    if (p == from || piece.newlines_before != 0 || foreign) {
      bool separate = fresh_ && before_ != nullptr && before_->ends_pou && !line.closes &&
                      text_.kind(line.first) != TokenKind::kEnd;
      layout_.open_row(layout_.columns_of(line.comment_level),
                       foreign ? RowKind::kVerbatim : RowKind::kComment,
                       separate || blank(piece.newlines_before));
      layout_.row().source_column = text_.column_of(piece.begin);
    } else {
      layout_.put_blank();
    }
    layout_.put_piece(piece);
    fresh_ = false;
    if (has_region_before(piece.end)) write_region();
  }
}

}  // namespace frontend::formatting
