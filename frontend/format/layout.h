// One logical line -> rows: flat when it fits, otherwise broken at its loosest operators, or with a
// line for each element of a list. Depends on the tokens, the kinds of the gaps between them, and
// on whether a list began with a line break; all of that is the same in the result.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "frontend/format/outline.h"
#include "frontend/format/rows.h"
#include "frontend/format/spacing.h"

namespace frontend::formatting {

class Layout {
 public:
  Layout(const Text& text, const Outline& outline, const FormatOptions& options, Rows& rows)
      : text_(text), outline_(outline), options_(options), rows_(rows) {}

  // Prepares `line`; `prefix_columns` stand in front of it in the same row.
  void measure(const Line& line);
  bool fits_flat(const Line& line, uint32_t prefix_columns) const;
  // Writes what was measured. A row is open before and after.
  void write(const Line& line);

  // Rows and comments, for the writer.
  void open_row(uint32_t indent, RowKind kind, bool blank_before);
  void put(std::string_view part);
  void put_blank();
  void put_piece(const Piece& piece);
  // After the code of the open row.
  void put_trailing(const Piece& piece);
  Row& row() { return rows_.rows.back(); }
  uint32_t columns_of(uint32_t level) const { return level * options_.indent; }

 private:
  struct Range {
    uint32_t first;
    uint32_t end;
    uint32_t base;  // indentation of the row in which it began
    uint32_t tail;  // columns that follow it in its last row
  };

  // layout.cc
  uint32_t width(uint32_t first, uint32_t end) const;
  bool forced(uint32_t first, uint32_t end) const;
  // The same for the gap in front of token `i`.
  bool forced_before(uint32_t i) const {
    return forced_sum_[i - first_ + 1] != forced_sum_[i - first_];
  }
  bool flat(const Range& range) const;
  void range(Range range);
  void range_flat(uint32_t first, uint32_t end);
  void condition(const Line& line);
  void instruction(const Line& line);
  void token(uint32_t i);
  void request_break(uint32_t indent, uint32_t comment_indent, bool blank_allowed);
  // gaps.cc
  void write_gap(uint32_t i);
  uint32_t trailing_pieces(const Gap& gap) const;
  void own_rows(uint32_t from, uint32_t to);
  void need_break();
  void take_break(bool blank);
  void measure_gap(uint32_t i);
  // breaks.cc
  void assignment(const Range& range, uint32_t op);
  void operators(const Range& range, Binding at);
  void primary(const Range& range);
  void list(const Range& group);
  void element(const Range& r, uint32_t group);
  void packed(const Range& group);
  bool is_packed(uint32_t open, uint32_t close) const;
  void match_brackets(const Line& line);
  uint32_t next_operator(uint32_t i, uint32_t end, Binding at) const;
  Binding loosest(uint32_t first, uint32_t end) const;
  uint32_t skip(uint32_t i) const {  // after the token or group at `i`
    return partner_[i - first_] > i ? partner_[i - first_] + 1 : i + 1;
  }
  void mark(uint32_t slot);
  void choose_marks(const Line& line);

  const Text& text_;
  const Outline& outline_;
  const FormatOptions& options_;
  Rows& rows_;

  uint32_t first_ = 0;                // of the measured line
  std::vector<uint32_t> partner_;     // of brackets; otherwise the token itself
  std::vector<bool> blank_;           // a blank in front of the token
  std::vector<uint32_t> before_;      // columns in front of the token: blanks and comments
  std::vector<uint32_t> width_sum_;   // columns of the tokens before, with what is in front of them
  std::vector<uint32_t> forced_sum_;  // breaks that must stay, before the token
  std::vector<uint32_t> stack_;
  uint32_t depth_ = 0;
  uint32_t next_group_ = 1u << 31;  // above the blocks' numbers

  uint32_t marked_[kMarks] = {};  // tokens in front of which a row is padded
  uint32_t continuation_ = 0;     // indentation where a comment breaks what needed no break
  bool break_wanted_ = false;
  bool blank_allowed_ = false;
  uint32_t break_indent_ = 0;
  uint32_t comment_indent_ = 0;
};

}  // namespace frontend::formatting
