#include "frontend/format/layout.h"

#include "base/limits.h"
#include "frontend/format/outliner.h"
#include "frontend/format/spacing.h"
#include "frontend/lex/characters.h"

namespace frontend::formatting {

void Layout::measure(const Line& line) {
  first_ = line.first;
  uint32_t count = line.end - line.first;
  blank_.assign(count, false);
  // After the last token, too: there an operator may end the line, and nothing stands or breaks.
  before_.assign(count + 1, 0);
  width_sum_.assign(count + 1, 0);
  forced_sum_.assign(count + 2, 0);
  match_brackets(line);
  for (uint32_t k = 0; k < count; ++k) {
    uint32_t i = line.first + k;
    blank_[k] = k != 0 && blank_before(text_, line, i);
    forced_sum_[k + 1] = forced_sum_[k];
    if (k != 0) measure_gap(i);
    width_sum_[k + 1] = width_sum_[k] + before_[k] + text_.columns(text_.token(i));
  }
  forced_sum_[count + 1] = forced_sum_[count];
}

bool Layout::fits_flat(const Line& line, uint32_t prefix_columns) const {
  return !forced(line.first, line.end) &&
         columns_of(line.level) + prefix_columns + width(line.first, line.end) <= options_.width;
}

// Between the first token's begin and the last one's end.
uint32_t Layout::width(uint32_t first, uint32_t end) const {
  if (first >= end) return 0;
  return width_sum_[end - first_] - width_sum_[first - first_] - before_[first - first_];
}

// Must a break stand inside? What stands in front of the first token does not count.
bool Layout::forced(uint32_t first, uint32_t end) const {
  return first < end && forced_sum_[end - first_] != forced_sum_[first - first_ + 1];
}

bool Layout::flat(const Range& range) const {
  uint32_t used = rows_.rows.back().indent + rows_.rows.back().width;
  if (break_wanted_) {
    used = break_indent_;
  } else {
    used += before_[range.first - first_];
  }
  return !forced(range.first, range.end) &&
         used + width(range.first, range.end) + range.tail <= options_.width;
}

void Layout::write(const Line& line) {
  depth_ = 0;
  uint32_t base = columns_of(line.level);
  continuation_ = base + 2 * options_.indent;
  break_wanted_ = false;
  choose_marks(line);
  size_t rows_before = rows_.rows.size();
  if (line.kind == LineKind::kInstruction) {
    instruction(line);
  } else if (line.kind == LineKind::kCondition) {
    condition(line);
  } else if (line.label_end != 0) {
    range_flat(line.first, line.end);
  } else {
    uint32_t end = line.end;
    while (end > line.first + 1 && text_.kind(end - 1) == TokenKind::kSemicolon) --end;
    range({line.first, end, base, width(end, line.end)});
    range_flat(end, line.end);
  }
  bool aligned = false;
  for (uint32_t token : marked_) aligned = aligned || token != 0;
  if (!aligned) return;
  rows_.rows[rows_before - 1].group = line.block;
  // Only the first row is padded; the others do not part it from the next declaration.
  for (size_t k = rows_before; k < rows_.rows.size(); ++k) {
    Row& next = rows_.rows[k];
    if (next.group != 0) continue;
    for (uint32_t& at : next.mark) at = 0;
    next.group = line.block;
  }
}

// In front of AT, `:` and `:=` of a declaration, the `:=` of a statement, a label's statement.
void Layout::choose_marks(const Line& line) {
  for (uint32_t& token : marked_) token = 0;
  if (line.kind == LineKind::kInstruction) return;
  marked_[0] = line.label_end;
  bool declaration = line.kind == LineKind::kDeclaration && options_.align_declarations;
  bool statement = line.kind == LineKind::kStatement && options_.align_assignments;
  if ((!declaration && !statement) || line.label_end != 0 || line.opens) return;
  for (uint32_t i = line.first + 1; i < line.end; i = skip(i)) {
    TokenKind kind = text_.kind(i);
    if (kind == TokenKind::kAt && declaration && marked_[1] == 0) marked_[0] = i;
    if (kind == TokenKind::kColon && declaration && marked_[1] == 0) marked_[1] = i;
    if (kind == TokenKind::kAssign && marked_[2] == 0) marked_[2] = i;
  }
}

// IF a AND b THEN. When the condition is broken, the last word stands below the first.
void Layout::condition(const Line& line) {
  token(line.first);
  uint32_t end = line.end;
  TokenKind last = text_.kind(end - 1);
  bool closing = last == TokenKind::kThen || last == TokenKind::kDo || last == TokenKind::kOf;
  if (closing || last == TokenKind::kSemicolon) --end;
  if (end <= line.first + 1) return range_flat(line.first + 1, line.end);
  uint32_t base = columns_of(line.level);
  Range inner{line.first + 1, end, base, closing ? 1 + width(end, line.end) : 1};
  bool one_row = flat(inner) && !forced(end - 1, line.end);
  range(inner);
  if (closing && !one_row) request_break(base, base + 2 * options_.indent, false);
  range_flat(end, line.end);
}

// label: OPERATOR operand. Longer words only push what follows them in their row.
void Layout::instruction(const Line& line) {
  constexpr uint32_t kOperatorColumns = 6;
  uint32_t first = line.label_end != 0 ? line.label_end : line.first;
  uint32_t base = columns_of(line.level + line.label_levels);
  auto pad_to = [&](uint32_t i, uint32_t column) {
    if (text_.gap(i).count != 0) return;
    uint32_t used = row().indent + row().width;
    put(std::string(used < column ? column - used : 1, ' '));
    blank_[i - first_] = false;
  };
  for (uint32_t i = line.first + 1; i < first; ++i) {
    if (text_.kind(i) == TokenKind::kColon) blank_[i - first_] = false;
  }
  range_flat(line.first, first);
  if (first != line.first) pad_to(first, base);
  uint32_t operand = line.operand != 0 ? line.operand : line.end;
  for (uint32_t i = first + 1; i < operand; ++i) {  // `&N`, `AND(`
    bool deferred = i == first + 1 && text_.kind(i) == TokenKind::kLeftParen;
    if (line.operand != 0 || deferred) blank_[i - first_] = false;
  }
  range_flat(first, line.operand != 0 ? operand : first);
  if (line.operand != 0) pad_to(operand, base + kOperatorColumns);
  for (uint32_t i = operand; i < line.end; ++i) {  // of instructions in parentheses
    if (is_and_not(text_, i, line.end)) blank_[i + 1 - first_] = false;
  }
  bool sign = text_.kind(operand) == TokenKind::kMinus || text_.kind(operand) == TokenKind::kPlus;
  if (sign && operand + 1 < line.end) blank_[operand + 1 - first_] = false;
  uint32_t rest = line.operand != 0 ? operand : first;
  // Only brackets may be broken: the row is the instruction.
  if (line.one_row || loosest(rest, line.end) != Binding::kNone) return range_flat(rest, line.end);
  range({rest, line.end, base, 0});
}

void Layout::range(Range range) {
  if (range.first >= range.end) return;
  if (flat(range) || depth_ >= base::kMaxNesting) return range_flat(range.first, range.end);
  ++depth_;
  Binding at = loosest(range.first, range.end);
  if (at == Binding::kAssign) {
    assignment(range, next_operator(range.first, range.end, at));
  } else if (at != Binding::kNone) {
    operators(range, at);
  } else {
    primary(range);
  }
  --depth_;
}

void Layout::range_flat(uint32_t first, uint32_t end) {
  for (uint32_t i = first; i < end; ++i) token(i);
}

void Layout::token(uint32_t i) {
  for (uint32_t slot = 0; slot < kMarks && i != 0; ++slot) {
    if (i == marked_[slot]) mark(slot);
  }
  if (i != first_) write_gap(i);
  std::string_view word = text_.token(i);
  bool soft = outline_.soft_keywords[i];
  if (!options_.upper_keywords || (!is_keyword(text_.kind(i)) && !soft)) return put(word);
  size_t from = rows_.buffer.size();
  put(word);
  for (size_t k = from; k < rows_.buffer.size(); ++k) rows_.buffer[k] = to_upper(rows_.buffer[k]);
}

void Layout::open_row(uint32_t indent, RowKind kind, bool blank_before_row) {
  Row next;
  next.indent = indent;
  next.kind = kind;
  next.blank_before = blank_before_row && !rows_.rows.empty();
  next.begin = next.end = next.comment = static_cast<uint32_t>(rows_.buffer.size());
  rows_.rows.push_back(next);
}

void Layout::put(std::string_view part) {
  rows_.buffer += part;
  row().width += text_.columns(part);
  row().end = row().comment = static_cast<uint32_t>(rows_.buffer.size());
}

void Layout::put_blank() {
  if (row().end != row().begin) put(" ");
}

void Layout::request_break(uint32_t indent, uint32_t comment_indent, bool blank_allowed) {
  break_wanted_ = true;
  blank_allowed_ = blank_allowed;
  break_indent_ = indent;
  comment_indent_ = comment_indent;
}

// Padding goes in front of what is put next.
void Layout::mark(uint32_t slot) {
  row().mark[slot] = row().end - row().begin;
  row().mark_column[slot] = row().width;
}

}  // namespace frontend::formatting
