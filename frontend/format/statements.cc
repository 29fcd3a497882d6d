#include "frontend/format/outliner.h"
#include "ir/types/types.h"

namespace frontend::formatting {

void Outliner::statement_level() {
  if (is_block_end(kind())) return close();
  const bool inherits = kind() == TokenKind::kExtends || kind() == TokenKind::kImplements;
  if (inherits && !top().instructions) {
    // The rest of a head that USING has interrupted.
    uint32_t behind = behind_bases(at_);
    if (top().kind == BlockKind::kBody && behind != at_) {
      add(LineKind::kHead, behind_semicolons(behind), top().outer);
      return;
    }
  }
  if (instruction_list()) return;
  if (declaration_block() || head() || control() || soft_head() || exception_handling() ||
      case_label()) {
    return;
  }
  simple_statement();
}

bool Outliner::control() {
  switch (kind()) {
    case TokenKind::kIf:
      condition(TokenKind::kThen, TokenKind::kEndIf, BlockKind::kStatements);
      return true;
    case TokenKind::kCase:
      condition(TokenKind::kOf, TokenKind::kEndCase, BlockKind::kCase);
      return true;
    case TokenKind::kFor:
      condition(TokenKind::kDo, TokenKind::kEndFor, BlockKind::kStatements);
      return true;
    case TokenKind::kWhile:
      condition(TokenKind::kDo, TokenKind::kEndWhile, BlockKind::kStatements);
      return true;
    case TokenKind::kElse:
    case TokenKind::kElsif:
      branch(TokenKind::kThen);
      return true;
    case TokenKind::kRepeat:
      repeat();
      return true;
    case TokenKind::kUntil:
      until();
      return true;
    default:
      return false;
  }
}

void Outliner::condition(TokenKind until, TokenKind end, BlockKind block) {
  uint32_t i = at_ + 1;
  while (text_.kind(i) != until && text_.kind(i) != TokenKind::kSemicolon &&
         text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i))) {
    ++i;
  }
  if (text_.kind(i) == until) ++i;
  Line& line = add(LineKind::kCondition, i, top().inner);
  line.opens = true;
  push(end, block, top().inner + (block == BlockKind::kCase ? 2 : 1));
}

void Outliner::branch(TokenKind until) {
  bool is_else = kind() == TokenKind::kElse;
  uint32_t i = at_ + 1;
  while (!is_else && text_.kind(i) != until && text_.kind(i) != TokenKind::kSemicolon &&
         text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i))) {
    ++i;
  }
  if (text_.kind(i) == until) ++i;
  bool inside = blocks_.size() > 1;
  uint32_t inner = top().inner;
  Line& line =
      add(is_else ? LineKind::kHead : LineKind::kCondition, i, inside ? top().outer : inner);
  line.comment_level = inner;
  line.closes = line.opens = true;
  if (inside) top().inner = top().outer + 1;
}

void Outliner::repeat() {
  add_head(at_ + 1);
  push(TokenKind::kEndRepeat, BlockKind::kStatements, top().inner + 1);
}

void Outliner::until() {
  uint32_t i = at_ + 1;
  while (text_.kind(i) != TokenKind::kSemicolon && text_.kind(i) != TokenKind::kEnd &&
         !is_structural(text_.kind(i))) {
    ++i;
  }
  uint32_t inner = top().inner;
  bool inside = top().end == TokenKind::kEndRepeat;
  Line& line = add(LineKind::kCondition, behind_semicolons(i), inside ? top().outer : inner);
  line.comment_level = inner;
  line.closes = line.opens = true;
}

// __TRY ... __CATCH (e) ... __FINALLY ... __ENDTRY
bool Outliner::exception_handling() {
  if (kind() == TokenKind::kTry) {
    soft_keyword(at_);
    add_head(at_ + 1);
    push(TokenKind::kEndTry, BlockKind::kStatements, top().inner + 1);
    return true;
  }
  if (kind() == TokenKind::kEndTry) return close(), true;
  if (kind() != TokenKind::kCatch && kind() != TokenKind::kFinally) return false;
  bool inside = top().end == TokenKind::kEndTry;
  uint32_t behind = is_opening(kind(1)) ? behind_group(at_ + 1) : at_ + 1;
  uint32_t inner = top().inner;
  Line& line = add(LineKind::kHead, behind, inside ? top().outer : inner);
  line.comment_level = inner;
  line.closes = line.opens = true;
  return true;
}

// In a CASE, whatever reaches a colon before anything that only a statement has; elsewhere, a name
// and a colon.
bool Outliner::case_label() {
  bool in_case = top().kind == BlockKind::kCase;
  uint32_t i = at_;
  if (!in_case && (!is_name(kind()) || kind(1) != TokenKind::kColon)) return false;
  for (; text_.kind(i) != TokenKind::kColon; ++i) {
    TokenKind k = text_.kind(i);
    bool operand = k == TokenKind::kTrue || k == TokenKind::kFalse || k == TokenKind::kNot;
    if (k == TokenKind::kSemicolon || k == TokenKind::kAssign || k == TokenKind::kArrow ||
        k == TokenKind::kEnd || (is_keyword(k) && !operand)) {
      return false;
    }
  }
  bool branch_label = in_case && top().inner != top().outer + 1;
  Line& line = add(LineKind::kLabel, i + 1, branch_label ? top().outer + 1 : top().inner);
  line.opens = true;
  return true;
}

void Outliner::simple_statement() {
  if ((kind() == TokenKind::kContinue && kind(1) == TokenKind::kSemicolon) ||
      ((kind() == TokenKind::kJump || kind() == TokenKind::kMock ||
        kind() == TokenKind::kMockFunction || kind() == TokenKind::kUsing) &&
       is_name(kind(1)))) {
    soft_keyword(at_);
  }
  uint32_t i = at_;
  bool configured =
      top().end == TokenKind::kEndResource || top().end == TokenKind::kEndConfiguration;
  if (configured) {
    if (is_name(kind()) && is_name(kind(1))) soft_keyword(at_);  // TASK
    ++i;                                                         // PROGRAM
  }
  while (text_.kind(i) != TokenKind::kSemicolon && text_.kind(i) != TokenKind::kEnd &&
         !is_structural(text_.kind(i))) {
    if (configured && text_.kind(i) == TokenKind::kWith) soft_keyword(i);
    if (text_.kind(i) == TokenKind::kReturns && i > at_ + 1) soft_keyword(i);
    ++i;
  }
  bool head = kind() == TokenKind::kUsing && top().kind == BlockKind::kBody;
  add(LineKind::kStatement, behind_semicolons(i), head ? top().outer : top().inner);
}

}  // namespace frontend::formatting
