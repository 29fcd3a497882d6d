// Rows -> text.
#include <algorithm>

#include "frontend/format/rows.h"

namespace frontend::formatting {

namespace {

constexpr uint32_t kCommentGap = 2;
// A cell wider than this, such as a list of names, does not push its neighbours to the right.
constexpr uint32_t kWidestCell = 36;

class Aligner {
 public:
  Aligner(const Rows& rows, const FormatOptions& options, const Text& text)
      : rows_(rows.rows), buffer_(rows.buffer), options_(options), text_(text) {
    pads_.resize(rows_.size());
    comment_pad_.assign(rows_.size(), kCommentGap);
    size_t newline = text.text().find('\n');
    bool dos =
        newline != std::string_view::npos && newline != 0 && text.text()[newline - 1] == '\r';
    line_end_ = dos ? "\r\n" : "\n";
  }
  std::string run();

 private:
  struct Pads {
    uint32_t at[kMarks] = {};
    bool sticks_out = false;  // a cell was too wide; the rest of the row is on its own
  };
  void align_groups();
  void align_marks(size_t from, size_t to, uint32_t slot);
  void align_comments();
  bool continues_comments(size_t row) const;
  void align_comment_run(size_t from, size_t to);
  uint32_t columns(size_t row) const;  // of the code, with indentation and padding
  bool has_comment(size_t row) const { return rows_[row].comment != rows_[row].end; }

  void write(size_t row);
  void write_code(size_t row);
  void write_indent(uint32_t columns);
  void write_comment(std::string_view comment, uint32_t source_column);
  uint32_t current_column() const;
  void write_lines(std::string_view lines);
  std::string_view part(uint32_t begin, uint32_t end) const {
    return std::string_view(buffer_).substr(begin, end - begin);
  }

  const std::vector<Row>& rows_;
  const std::string& buffer_;
  const FormatOptions& options_;
  const Text& text_;
  std::vector<Pads> pads_;
  std::vector<uint32_t> comment_pad_;
  std::string line_end_;
  std::string out_;
};

std::string Aligner::run() {
  align_groups();
  if (options_.align_comments) align_comments();
  out_.reserve(buffer_.size() + buffer_.size() / 4 + 16);
  if (text_.has_byte_order_mark()) out_ += "\xEF\xBB\xBF";
  for (size_t row = 0; row < rows_.size(); ++row) {
    if (row != 0 && rows_[row].kind != RowKind::kJoined && !out_.ends_with('\n')) out_ += line_end_;
    write(row);
  }
  if (!rows_.empty() && !out_.ends_with('\n')) out_ += line_end_;
  return std::move(out_);
}

// Runs of rows with the same group; comments between them do not end a run, blank lines do.
void Aligner::align_groups() {
  for (size_t from = 0; from < rows_.size();) {
    uint32_t group = rows_[from].group;
    size_t to = from + 1;
    while (group != 0 && to < rows_.size() && !rows_[to].blank_before &&
           (rows_[to].group == group || rows_[to].kind == RowKind::kComment)) {
      ++to;
    }
    for (uint32_t slot = 0; group != 0 && slot < kMarks; ++slot) align_marks(from, to, slot);
    from = to;
  }
}

void Aligner::align_marks(size_t from, size_t to, uint32_t slot) {
  auto column = [&](size_t row) {
    uint32_t at = rows_[row].mark_column[slot];
    for (uint32_t before = 0; before < slot; ++before) at += pads_[row].at[before];
    return at;
  };
  auto takes_part = [&](size_t row) {
    if (rows_[row].mark[slot] == 0 || pads_[row].sticks_out) return false;
    uint32_t cell_begin = 0;
    for (uint32_t before = 0; before < slot; ++before) {
      cell_begin = std::max(cell_begin, rows_[row].mark_column[before]);
    }
    return rows_[row].mark_column[slot] - cell_begin <= kWidestCell;
  };
  uint32_t widest = 0;
  for (size_t row = from; row < to; ++row) {
    if (takes_part(row)) widest = std::max(widest, column(row));
  }
  for (size_t row = from; row < to; ++row) {
    if (!takes_part(row)) continue;
    // Not at the price of a line that is too long.
    if (columns(row) + widest - column(row) > options_.width) return;
  }
  for (size_t row = from; row < to; ++row) {
    if (takes_part(row)) {
      pads_[row].at[slot] = widest - column(row);
    } else if (rows_[row].mark[slot] != 0) {
      pads_[row].sticks_out = true;
    }
  }
}

uint32_t Aligner::columns(size_t row) const {
  uint32_t sum = rows_[row].indent + rows_[row].width;
  for (uint32_t pad : pads_[row].at) sum += pad;
  return sum;
}

void Aligner::align_comments() {
  for (size_t from = 0; from < rows_.size();) {
    size_t to = from + 1;
    while (to < rows_.size() && continues_comments(to)) ++to;
    align_comment_run(from, to);
    from = to;
  }
}

// Declarations of one block belong together, otherwise rows that all have comments.
bool Aligner::continues_comments(size_t row) const {
  const Row& here = rows_[row];
  const Row& before = rows_[row - 1];
  if (here.blank_before || here.indent != before.indent || here.kind != RowKind::kCode ||
      before.kind != RowKind::kCode) {
    return false;
  }
  bool same_group = here.group != 0 && here.group == before.group;
  return same_group || (has_comment(row) && has_comment(row - 1));
}

// A few long rows do not push all comments to the right.
void Aligner::align_comment_run(size_t from, size_t to) {
  uint32_t limit = options_.width * 2 / 3;
  uint32_t widest = 0;
  for (size_t row = from; row < to; ++row) {
    if (has_comment(row) && columns(row) <= limit) widest = std::max(widest, columns(row));
  }
  for (size_t row = from; row < to; ++row) {
    if (columns(row) <= widest) comment_pad_[row] = widest - columns(row) + kCommentGap;
  }
}

void Aligner::write(size_t row) {
  const Row& r = rows_[row];
  if (r.blank_before) out_ += line_end_;
  if (r.kind == RowKind::kVerbatim || r.kind == RowKind::kJoined) {
    write_lines(part(r.begin, r.end));
  } else if (r.kind == RowKind::kComment) {
    write_indent(r.indent);
    write_comment(part(r.begin, r.end), r.source_column);
  } else {
    write_indent(r.indent);
    write_code(row);
  }
  if (!has_comment(row)) return;
  out_.append(comment_pad_[row], ' ');
  write_comment(part(r.end, r.comment), r.source_column);
}

void Aligner::write_code(size_t row) {
  const Row& r = rows_[row];
  uint32_t done = r.begin;
  for (uint32_t slot = 0; slot < kMarks; ++slot) {
    if (r.mark[slot] == 0 || pads_[row].at[slot] == 0) continue;
    write_lines(part(done, r.begin + r.mark[slot]));
    out_.append(pads_[row].at[slot], ' ');
    done = r.begin + r.mark[slot];
  }
  write_lines(part(done, r.end));
}

void Aligner::write_indent(uint32_t columns) {
  if (options_.tabs && options_.indent != 0) {
    out_.append(columns / options_.indent, '\t');
    columns %= options_.indent;
  }
  out_.append(columns, ' ');
}

uint32_t Aligner::current_column() const {
  size_t newline = out_.rfind('\n');
  size_t begin = newline == std::string::npos ? 0 : newline + 1;
  uint32_t columns = text_.columns(std::string_view(out_).substr(begin));
  return columns - (begin == 0 && text_.has_byte_order_mark() ? 1 : 0);
}

// The lines of a comment move with its first one, as far as there are blanks in front of them.
void Aligner::write_comment(std::string_view comment, uint32_t source_column) {
  size_t newline = comment.find('\n');
  if (newline == std::string_view::npos || source_column == Text::kUnknownColumn || options_.tabs) {
    return write_lines(comment);
  }
  uint32_t column = current_column();
  uint32_t room = source_column;  // blanks that every line has, at most those of the first one
  for (size_t at = newline; at != std::string_view::npos; at = comment.find('\n', at + 1)) {
    size_t text = comment.find_first_not_of(' ', at + 1);
    if (text == std::string_view::npos || comment[text] == '\n') continue;
    room = std::min(room, static_cast<uint32_t>(text - at - 1));
  }
  bool right = column >= source_column;
  uint32_t shift = right ? column - source_column : std::min(source_column - column, room);
  for (;;) {
    newline = comment.find('\n');
    out_ += comment.substr(0, newline);
    if (newline == std::string_view::npos) return;
    out_ += line_end_;
    comment.remove_prefix(newline + 1);
    bool empty = comment.empty() || comment.front() == '\n';
    if (empty) continue;
    if (right) {
      out_.append(shift, ' ');
    } else {
      comment.remove_prefix(shift);
    }
  }
}

void Aligner::write_lines(std::string_view lines) {
  for (;;) {
    size_t newline = lines.find('\n');
    std::string_view line = lines.substr(0, newline);
    if (newline != std::string_view::npos && line.ends_with('\r')) line.remove_suffix(1);
    out_ += line;
    if (newline == std::string_view::npos) return;
    out_ += line_end_;
    lines.remove_prefix(newline + 1);
  }
}

}  // namespace

std::string align(const Rows& rows, const FormatOptions& options, const Text& text) {
  return Aligner(rows, options, text).run();
}

}  // namespace frontend::formatting
