#include "frontend/format/branches.h"
#include "frontend/format/diagrams.h"
#include "frontend/format/outliner.h"
#include "frontend/format/spacing.h"

namespace frontend::formatting {

bool Outliner::head() {
  switch (kind()) {
    case TokenKind::kFunction:
      pou(TokenKind::kEndFunction, BlockKind::kBody);
      return true;
    case TokenKind::kFunctionBlock:
      pou(TokenKind::kEndFunctionBlock, BlockKind::kBody);
      return true;
    case TokenKind::kProgram:
      // In a resource it declares an instance, as a statement.
      if (top().end == TokenKind::kEndResource || top().end == TokenKind::kEndConfiguration) {
        return false;
      }
      pou(TokenKind::kEndProgram, BlockKind::kBody);
      return true;
    case TokenKind::kConfiguration:
      named_group(TokenKind::kEndConfiguration, BlockKind::kGroup);
      top().pou = true;
      return true;
    default:
      return false;
  }
}

// TRANSITION (PRIORITY := 1) FROM ..., as the parser tells it from a call.
bool Outliner::has_priority(uint32_t i) const {
  return text_.kind(i + 1) == TokenKind::kLeftParen && is_name(text_.kind(i + 2)) &&
         text_.kind(i + 3) == TokenKind::kAssign && text_.kind(i + 5) == TokenKind::kRightParen &&
         text_.is_word(i + 6, "FROM");
}

// Does a member or part of a chart begin at `i`? As soft_head() sees it.
bool Outliner::begins_member(uint32_t i) const {
  const TokenKind next = text_.kind(i + 1);
  const bool named = is_name(next) && text_.kind(i + 2) != TokenKind::kEqual;
  switch (text_.kind(i)) {
    case TokenKind::kMethod:
    case TokenKind::kProperty:
    case TokenKind::kInterface:
    case TokenKind::kClass:
    case TokenKind::kAction:
    case TokenKind::kNamespace:
    case TokenKind::kStep:
    case TokenKind::kInitialStep:
    case TokenKind::kMockFunction:
      return named;
    case TokenKind::kTransition:
      return named || has_priority(i);
    case TokenKind::kTest:
      return next == TokenKind::kString;
    default:
      return false;
  }
}

// Words that are names elsewhere: they open something only before another name. Never so in a
// statement, except `step S= x`; in an instruction list, what stands in no POU is a function.
bool Outliner::soft_head() {
  TokenKind k = kind();
  if (!is_name(k)) return false;
  if (k == TokenKind::kName) return false;
  TokenKind next = kind(1);
  bool named = is_name(next) && kind(2) != TokenKind::kEqual;
  switch (k) {
    case TokenKind::kSetup:
      return !top().instructions && setup(TokenKind::kEndSetup);
    case TokenKind::kTeardown:
      return !top().instructions && setup(TokenKind::kEndTeardown);
    case TokenKind::kMockFunction:
      return named && mock_function();
    case TokenKind::kMethod:
      if (named) pou(TokenKind::kEndMethod, BlockKind::kBody);
      return named;
    case TokenKind::kProperty:
      if (named) pou(TokenKind::kEndProperty, BlockKind::kProperty);
      return named;
    case TokenKind::kInterface:
      if (named) pou(TokenKind::kEndInterface, BlockKind::kGroup);
      return named;
    case TokenKind::kClass:
      if (named) pou(TokenKind::kEndClass, BlockKind::kBody);
      return named;
    case TokenKind::kAction:
      if (named) pou(TokenKind::kEndAction, BlockKind::kBody);
      return named;
    case TokenKind::kNamespace:
      if (named) named_group(TokenKind::kEndNamespace, BlockKind::kGroup);
      return named;
    case TokenKind::kResource:
      if (!named || top().instructions) return false;
      named_group(TokenKind::kEndResource, BlockKind::kGroup);
      return true;
    case TokenKind::kStep:
    case TokenKind::kInitialStep:
      if (named) step(TokenKind::kEndStep);
      return named;
    case TokenKind::kTransition:
      if (!named && !has_priority(at_)) return false;
      transition();
      return true;
    case TokenKind::kTest:
      if (next == TokenKind::kString) test();
      return next == TokenKind::kString;
    case TokenKind::kLadder:
    case TokenKind::kFbd:
      if (!ends_diagram(k, next)) return false;
      soft_keyword(at_);
      add_head(at_ + 1);
      push(next, BlockKind::kGroup, top().inner + 1);
      return true;
    case TokenKind::kGet:
    case TokenKind::kSet:
      if (top().end == TokenKind::kEndGet || top().end == TokenKind::kEndSet) blocks_.pop_back();
      if (top().kind != BlockKind::kProperty) return false;
      property_part(k == TokenKind::kGet ? TokenKind::kEndGet : TokenKind::kEndSet);
      return true;
    default:
      return false;
  }
}

void Outliner::pou(TokenKind end, BlockKind block) {
  soft_keyword(at_);
  // In an interface the end of a method or property may be missing; they do not nest.
  if (kind() == TokenKind::kMethod || kind() == TokenKind::kProperty) {
    while (top().end == TokenKind::kEndMethod || top().end == TokenKind::kEndProperty ||
           top().end == TokenKind::kEndGet || top().end == TokenKind::kEndSet) {
      blocks_.pop_back();
    }
  }
  bool typed = kind() == TokenKind::kFunction || kind() == TokenKind::kMethod ||
               kind() == TokenKind::kProperty || kind() == TokenKind::kMockFunction;
  bool action = kind() == TokenKind::kAction;
  uint32_t i = behind_bases(behind_name(behind_modifiers(at_ + 1)));
  if (typed && text_.kind(i) == TokenKind::kColon) i = behind_type(i + 1);
  if (action && text_.kind(i) == TokenKind::kColon) ++i;
  LineKind line_kind = action ? LineKind::kLabel : LineKind::kHead;
  Line& line = add(line_kind, behind_semicolons(i), top().inner);
  line.opens = true;
  bool separate = top().end != TokenKind::kEndInterface;
  push(end, block, top().inner + 1);
  top().pou = separate;
}

void Outliner::named_group(TokenKind end, BlockKind block) {
  soft_keyword(at_);
  uint32_t i = behind_name(behind_modifiers(at_ + 1));
  if (text_.kind(i) == TokenKind::kOn && is_name(text_.kind(i + 1))) {  // RESOURCE r ON PLC
    soft_keyword(i);
    i = behind_name(i + 1);
  }
  add_head(behind_semicolons(i));
  push(end, block, top().inner + 1);
  top().pou = end == TokenKind::kEndNamespace;
}

void Outliner::property_part(TokenKind end) {
  soft_keyword(at_);
  uint32_t behind = at_ + 1;
  if (is_access(text_.kind(behind)) && !follows_a_name(text_.kind(behind + 1))) {
    soft_keyword(behind++);
  }
  add_head(behind);
  push(end, BlockKind::kBody, top().inner + 1);
}

void Outliner::step(TokenKind end) {
  soft_keyword(at_);
  uint32_t i = behind_name(at_ + 1);
  if (text_.kind(i) == TokenKind::kColon) ++i;
  Line& line = add(LineKind::kLabel, i, top().inner);
  line.opens = true;
  push(end, BlockKind::kGroup, top().inner + 1);
}

// TRANSITION name (PRIORITY := 1) FROM a TO b, then `:= condition;` or `:` and instructions.
void Outliner::transition() {
  soft_keyword(at_);
  uint32_t i = at_ + 1;
  while (text_.kind(i) != TokenKind::kAssign && text_.kind(i) != TokenKind::kColon &&
         text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i))) {
    if (is_opening(text_.kind(i))) {
      if (text_.is_word(i + 1, "PRIORITY")) soft_keyword(i + 1);
      i = behind_group(i);
    } else {
      if (text_.is_word(i, "FROM")) soft_keyword(i);
      ++i;
    }
  }
  if (text_.kind(i) == TokenKind::kColon) ++i;
  if (text_.kind(i) == TokenKind::kAssign) {
    while (text_.kind(i) != TokenKind::kSemicolon && text_.kind(i) != TokenKind::kEnd &&
           !is_structural(text_.kind(i))) {
      ++i;
    }
    i = behind_semicolons(i);
  }
  add_head(i);
  push(TokenKind::kEndTransition, BlockKind::kBody, top().inner + 1);
}

void Outliner::test() {
  soft_keyword(at_);
  add_head(at_ + 2);
  push(TokenKind::kEndTest, BlockKind::kBody, top().inner + 1);
  top().pou = true;
}

// MOCK_FUNCTION with a body; with RETURNS or nothing it is a statement.
bool Outliner::mock_function() {
  TokenKind next = text_.kind(behind_name(at_ + 1));
  if (next == TokenKind::kSemicolon || next == TokenKind::kReturns) return false;
  pou(TokenKind::kEndMockFunction, BlockKind::kBody);
  return true;
}

// SETUP and TEARDOWN have no name; a statement cannot go on with a word.
bool Outliner::setup(TokenKind end) {
  if (!is_keyword(kind(1)) && (!is_name(kind(1)) || kind(2) == TokenKind::kEqual)) return false;
  soft_keyword(at_);
  add_head(at_ + 1);
  push(end, BlockKind::kBody, top().inner + 1);
  top().pou = true;
  return true;
}

uint32_t Outliner::behind_modifiers(uint32_t i) {
  for (; is_name(text_.kind(i + 1)); ++i) {
    switch (text_.kind(i)) {
      case TokenKind::kAbstract:
      case TokenKind::kFinal:
      case TokenKind::kInternal:
      case TokenKind::kPrivate:
      case TokenKind::kProtected:
      case TokenKind::kPublic:
      case TokenKind::kOverride:
        break;
      default:
        return i;
    }
    TokenKind next = text_.kind(i + 1);
    if (next == TokenKind::kExtends || next == TokenKind::kImplements) return i;
    soft_keyword(i);
  }
  return i;
}

uint32_t Outliner::behind_name(uint32_t i) const {
  // `x S= y` is a statement, whatever stands before it.
  if (!is_name(text_.kind(i)) || is_set_assignment(text_, i + 1)) return i;
  // A word of a branch that is left out has no name in the instruction after it.
  if (blocks_.back().instructions && ends_branch(text_, i)) return i;
  for (++i; text_.kind(i) == TokenKind::kDot && is_name(text_.kind(i + 1)); i += 2) {
  }
  return i;
}

uint32_t Outliner::behind_bases(uint32_t i) {
  while ((text_.kind(i) == TokenKind::kExtends || text_.kind(i) == TokenKind::kImplements) &&
         is_name(text_.kind(i + 1))) {
    soft_keyword(i);
    i = behind_name(i + 1);
    while (text_.kind(i) == TokenKind::kComma && is_name(text_.kind(i + 1))) i = behind_name(i + 1);
  }
  return i;
}

uint32_t Outliner::behind_type(uint32_t i) {
  for (;;) {
    TokenKind k = text_.kind(i);
    if (k == TokenKind::kArray) {
      if (is_opening(text_.kind(++i))) i = behind_group(i);
      if (text_.kind(i) == TokenKind::kOf) ++i;
    } else if (k == TokenKind::kRefTo) {
      soft_keyword(i++);
    } else if (text_.kind(i + 1) == TokenKind::kTo) {  // POINTER TO, REFERENCE TO
      soft_keyword(i);
      i += 2;
    } else {
      break;
    }
  }
  if (text_.kind(i) == TokenKind::kStringType || text_.kind(i) == TokenKind::kWideStringType) {
    soft_keyword(i);
  }
  i = behind_name(i);
  return is_opening(text_.kind(i)) ? behind_group(i) : i;
}

uint32_t Outliner::behind_group(uint32_t i) const {
  uint32_t depth = 0;
  for (; text_.kind(i) != TokenKind::kEnd && !is_structural(text_.kind(i)); ++i) {
    if (is_opening(text_.kind(i))) ++depth;
    if (is_closing_bracket(text_.kind(i)) && --depth == 0) return i + 1;
  }
  return i;
}

}  // namespace frontend::formatting
