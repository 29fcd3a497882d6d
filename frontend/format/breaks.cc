// How a range that does not fit is broken.
#include <algorithm>

#include "frontend/format/layout.h"
#include "frontend/format/outliner.h"

namespace frontend::formatting {

void Layout::match_brackets(const Line& line) {
  partner_.resize(line.end - line.first);
  stack_.clear();
  for (uint32_t i = line.first; i < line.end; ++i) {
    partner_[i - first_] = i;
    if (is_opening(text_.kind(i))) stack_.push_back(i);
    if (!is_closing_bracket(text_.kind(i)) || stack_.empty()) continue;
    partner_[i - first_] = stack_.back();
    partner_[stack_.back() - first_] = i;
    stack_.pop_back();
  }
}

// Outside of brackets. Commas and assignments bind looser than all operators.
Binding Layout::loosest(uint32_t first, uint32_t end) const {
  Binding found = Binding::kNone;
  for (uint32_t i = first; i < end; i = skip(i)) {
    if (i != first) found = std::min(found, binding(text_, i, first_));
  }
  return found;
}

uint32_t Layout::next_operator(uint32_t i, uint32_t end, Binding at) const {
  for (i = skip(i); i < end; i = skip(i)) {
    if (binding(text_, i, first_) == at) return i;
  }
  return end;
}

// `name : TYPE := value`, `place := value`, `parameter => place`.
void Layout::assignment(const Range& r, uint32_t op) {
  range({r.first, op, r.base, width(op, op + 1) + 1});
  token(op);
  range({op + 1, r.end, r.base, r.tail});
}

// Conditions have one operand per row; other operators and commas fill rows.
void Layout::operators(const Range& r, Binding at) {
  bool fills = at == Binding::kComma || at > Binding::kAnd;
  uint32_t base = r.base + 2 * options_.indent;
  uint32_t first = r.first;
  uint32_t op = next_operator(first, r.end, at);
  for (;;) {
    bool last = op >= r.end;
    uint32_t behind = at == Binding::kComma && !last ? 1 : 0;
    range({first, op, base, last ? r.tail : behind});
    if (last) return;
    uint32_t next = next_operator(op, r.end, at);
    uint32_t used = row().indent + row().width;
    if (at == Binding::kComma) {
      token(op);
      bool full = used + 2 + width(op + 1, next) + (next < r.end ? 1 : r.tail) > options_.width;
      if (full || forced_before(op + 1)) request_break(base, base, false);
    } else {
      bool full = used + 1 + width(op, next) + (next < r.end ? 0 : r.tail) > options_.width;
      if (!fills || full || forced_before(op)) request_break(base, base, false);
      token(op);
    }
    first = op + 1;
    op = next;
  }
}

// Names, brackets and words without operators: lists that must be broken are, or else the widest.
void Layout::primary(const Range& r) {
  uint32_t widest = r.end;
  bool any_forced = false;
  for (uint32_t i = r.first; i < r.end; i = skip(i)) {
    uint32_t close = partner_[i - first_];
    if (close <= i + 1) continue;
    any_forced = any_forced || forced(i, close + 1);
    if (widest == r.end || width(i, close) > width(widest, partner_[widest - first_])) widest = i;
  }
  for (uint32_t i = r.first; i < r.end; i = skip(i)) {
    uint32_t close = partner_[i - first_];
    bool group = close > i + 1;
    if (!group || !(any_forced ? forced(i, close + 1) : i == widest)) {
      range_flat(i, skip(i));
      continue;
    }
    uint32_t tail = close + 1 < r.end ? width(close + 1, r.end) : 0;
    Range inside{i, close + 1, r.base, tail + r.tail};
    GroupKind kind = group_kind(text_, i, close, first_);
    if (kind == GroupKind::kList) {
      is_packed(i, close) ? packed(inside) : list(inside);
    } else {
      token(i);
      range({i + 1, close, r.base, 1 + inside.tail});
      token(close);
    }
  }
}

// An element per row, the closing bracket below.
void Layout::list(const Range& r) {
  uint32_t close = r.end - 1;
  uint32_t inner = r.base + options_.indent;
  uint32_t group = next_group_++;
  token(r.first);
  request_break(inner, inner, false);
  for (uint32_t i = r.first + 1; i < close;) {
    uint32_t end = i;
    while (end < close && text_.kind(end) != TokenKind::kComma) end = skip(end);
    element({i, end, inner, 1}, group);
    if (end < close) token(end);
    i = end + 1;
    request_break(inner, inner, i < close);
  }
  request_break(r.base, inner, false);
  token(close);
}

// `name := value` and `name => place` are aligned with their neighbours.
void Layout::element(const Range& r, uint32_t group) {
  uint32_t op = next_operator(r.first, r.end, Binding::kAssign);
  if (loosest(r.first, r.end) != Binding::kAssign || !options_.align_arguments ||
      forced(r.first, op + 1)) {
    return range(r);
  }
  range_flat(r.first, op);
  mark(2);
  size_t rows_before = rows_.rows.size();
  token(op);
  range({op + 1, r.end, r.base, r.tail});
  for (size_t k = rows_before - 1; k < rows_.rows.size(); ++k) {
    if (rows_.rows[k].group == 0) rows_.rows[k].group = group;
  }
}

// Initial values without others inside, as in tables, fill rows; parameters and enumerators do not.
bool Layout::is_packed(uint32_t open, uint32_t close) const {
  bool value = open == first_ || text_.kind(open) == TokenKind::kLeftBracket ||
               text_.kind(open - 1) == TokenKind::kAssign ||
               text_.kind(open - 1) == TokenKind::kComma || is_opening(text_.kind(open - 1));
  if (!value) return false;
  for (uint32_t i = open + 1; i < close; i = skip(i)) {
    bool repetition =
        text_.kind(i) == TokenKind::kLeftParen && text_.kind(i - 1) == TokenKind::kInteger;
    if (partner_[i - first_] > i && !repetition) return false;
  }
  return true;
}

void Layout::packed(const Range& r) {
  uint32_t close = r.end - 1;
  uint32_t inner = r.base + options_.indent;
  token(r.first);
  request_break(inner, inner, false);
  for (uint32_t i = r.first + 1; i < close;) {
    uint32_t end = i;
    while (end < close && text_.kind(end) != TokenKind::kComma) end = skip(end);
    bool comma = end < close;
    range({i, end, inner, 1});
    if (comma) token(end);
    i = end + 1;
    uint32_t next = i;
    while (next < close && text_.kind(next) != TokenKind::kComma) next = skip(next);
    uint32_t used = row().indent + row().width;
    bool full = used + 2 + width(i, next) > options_.width;
    // A table keeps the rows that it was written in.
    bool new_row = i < close && text_.row(i) != text_.row(i - 1);
    if (i < close && (full || new_row || forced_before(i))) {
      request_break(inner, inner, false);
    }
  }
  request_break(r.base, inner, false);
  token(close);
}

}  // namespace frontend::formatting
