// Instruction lists: a line for each row. Labels stand at the left, operators and operands in
// columns.
#include <algorithm>

#include "frontend/format/outliner.h"
#include "frontend/format/spacing.h"
#include "frontend/parse/il_operators.h"

namespace frontend::formatting {

namespace {

// What a wider label takes does not push the whole list to the right.
constexpr uint32_t kWidestLabel = 16;

}  // namespace

// Decided once for a body. No statement looks like an instruction.
bool Outliner::instruction_list() {
  if (top().kind != BlockKind::kBody || is_block_end(kind())) return false;
  if (!top().instructions) {
    if (!text_.il_tokens().is_instruction_list(at_)) return false;
    top().instructions = true;
    top().label_levels = label_levels();
  }
  if (head() || soft_head()) return true;
  instruction();
  return true;
}

void Outliner::instruction() {
  uint32_t behind = behind_labels(at_);
  bool nested = false;
  bool alone = text_.kind(behind) == TokenKind::kEnd || is_structural(text_.kind(behind)) ||
               text_.row(behind) != text_.row(behind - 1);
  if (behind != at_ && alone) {
    Line& line = add(LineKind::kLabel, at_ + 2, top().inner);
    line.comment_level += top().label_levels;
    return;
  }
  uint32_t level = top().inner + top().label_levels;
  uint32_t end = behind_row(behind, nested);
  if (nested) {
    add(LineKind::kVerbatim, end, level);
    return;
  }
  bool labelled = behind != at_;
  if (find_il_operator(text_.token(behind)) != nullptr) soft_keyword(behind);
  Line& line = add(LineKind::kInstruction, end, labelled ? top().inner : level);
  line.comment_level = level;
  line.label_end = labelled ? behind : 0;
  line.label_levels = labelled ? top().label_levels : 0;
  for (uint32_t i = behind; i < end; ++i) line.one_row = line.one_row || is_deferred(i);
  uint32_t operand = behind + 1;
  if (is_and_not(text_, behind, end)) ++operand;
  if (is_deferred(behind)) ++operand;
  bool call = !is_deferred(behind) && is_opening(text_.kind(operand));
  bool name = text_.kind(operand) == TokenKind::kDot || text_.kind(operand) == TokenKind::kEqual;
  line.operand = operand < end && !call && !name ? operand : 0;
}

// Is the operator at `i` followed by a parenthesis that instructions fill?
bool Outliner::is_deferred(uint32_t i) const {
  const IlOperator* op = find_il_operator(text_.token(i));
  return op != nullptr && op->action == IlAction::kBinary &&
         text_.kind(i + 1) == TokenKind::kLeftParen;
}

uint32_t Outliner::behind_labels(uint32_t i) const {
  while (is_name(text_.kind(i)) && text_.kind(i + 1) == TokenKind::kColon) i += 2;
  return i;
}

// After the last token of the row; the brackets of a call may fill several. `nested`: an argument
// in them has instructions of its own, whose rows mean something.
uint32_t Outliner::behind_row(uint32_t i, bool& nested) const {
  uint32_t depth = 0;
  uint32_t first = i;
  for (; text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i)); ++i) {
    if (i != first && depth == 0 && text_.row(i) != text_.row(i - 1)) break;
    TokenKind k = text_.kind(i);
    if (is_opening(k) && (i == first || !is_deferred(i - 1))) {
      ++depth;
      nested = nested || (depth > 1 && text_.il_tokens().is_instruction(i + 1));
    }
    if (is_closing_bracket(k) && depth > 0) --depth;
  }
  return std::max(i, first + 1);
}

uint32_t Outliner::label_levels() const {
  uint32_t widest = 0;
  bool any = false;
  bool nested = false;
  for (uint32_t i = at_; text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i));) {
    if (begins_member(i)) break;
    uint32_t behind = behind_labels(i);
    any = any || behind != i;
    if (text_.kind(behind) == TokenKind::kEnd || is_structural(text_.kind(behind))) break;
    if (behind != i && text_.row(behind) != text_.row(behind - 1)) {  // a row of its own
      i = behind;
      continue;
    }
    if (behind != i) {
      uint32_t width = (behind - i) / 2 - 1;  // blanks between several
      for (uint32_t k = i; k < behind; ++k) width += text_.columns(text_.token(k));
      if (width <= kWidestLabel) widest = std::max(widest, width);
    }
    i = behind_row(behind, nested);
  }
  return indent_ == 0 || !any ? 0 : widest / indent_ + 1;
}

}  // namespace frontend::formatting
