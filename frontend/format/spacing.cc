#include "frontend/format/spacing.h"

#include "frontend/format/outliner.h"
#include "frontend/lex/operands.h"

namespace frontend::formatting {

namespace {

bool is_number(TokenKind kind) {
  return kind == TokenKind::kInteger || kind == TokenKind::kReal || kind == TokenKind::kDirect ||
         kind == TokenKind::kDuration || kind == TokenKind::kDate;
}

bool is_sign(const Text& text, uint32_t i, uint32_t first) {
  TokenKind kind = text.kind(i);
  return (kind == TokenKind::kMinus || kind == TokenKind::kPlus) &&
         (i == first || !ends_operand(text.kind(i - 1)));
}

// `AND(a, b)`: the function, where the operator would need an operand in front of it.
bool is_function_word(const Text& text, uint32_t i, uint32_t first) {
  TokenKind kind = text.kind(i);
  bool word = kind == TokenKind::kAnd || kind == TokenKind::kOr || kind == TokenKind::kXor ||
              kind == TokenKind::kMod;
  return word && (i == first || !ends_operand(text.kind(i - 1)));
}

bool adjacent(const Text& text, uint32_t i) { return text.end(i - 1) == text.begin(i); }

bool blank_before_bracket(const Text& text, const Line& line, uint32_t i, uint32_t first) {
  TokenKind before = text.kind(i - 1);
  if (before == TokenKind::kArray || before == TokenKind::kTypePrefix) return false;
  if (is_function_word(text, i - 1, first)) return false;
  if (!ends_operand(before)) return !is_sign(text, i - 1, first);
  // TRANSITION name (PRIORITY := 1) FROM (a, b)
  bool transition = line.kind == LineKind::kHead && text.kind(first) == TokenKind::kTransition;
  if (transition && (i <= first + 2 || text.is_word(i - 1, "FROM"))) return true;
  if (text.kind(i) == TokenKind::kLeftBracket || before != TokenKind::kName) return false;
  // TASK Fast (INTERVAL := ...); INT (0..100)
  if (i == first + 2 && text.kind(first) == TokenKind::kTask) return true;
  if (line.kind != LineKind::kDeclaration) return false;
  for (uint32_t k = i + 1; k < line.end && text.kind(k) != TokenKind::kRightParen; ++k) {
    if (text.kind(k) == TokenKind::kRange) return true;
    if (is_opening(text.kind(k))) return false;
  }
  return false;
}

bool blank_before_dot(const Text& text, uint32_t i, uint32_t first) {
  TokenKind before = text.kind(i - 1);
  if (before == TokenKind::kDot || before == TokenKind::kRange) return true;
  if (!ends_operand(before)) return !is_sign(text, i - 1, first);
  // `1 .5` would become a number; the bit in `a.1.2` does not.
  return is_number(before) && !adjacent(text, i);
}

bool blank_before_colon(const Line& line, uint32_t i) {
  if (line.label_end != 0) return i + 1 != line.label_end;
  return line.kind != LineKind::kLabel || i + 1 != line.end;
}

}  // namespace

bool is_set_assignment(const Text& text, uint32_t i) {
  if (text.kind(i) != TokenKind::kEqual || i < 2) return false;
  bool word = text.is_word(i - 1, "S") || text.is_word(i - 1, "R") || text.is_word(i - 1, "REF");
  return word && ends_operand(text.kind(i - 2)) && adjacent(text, i);
}

bool blank_before(const Text& text, const Line& line, uint32_t i) {
  TokenKind before = text.kind(i - 1);
  uint32_t first = line.first;
  switch (before) {
    case TokenKind::kLeftParen:  // not the beginning of a comment
      return text.kind(i) == TokenKind::kStar || text.kind(i) == TokenKind::kPower;
    case TokenKind::kLeftBracket:
      return false;
    case TokenKind::kDot:
    case TokenKind::kRange: {  // `1 .. 3` is `1..3`, but `.5` would become part of a number
      const bool number = is_number(text.kind(i)) && before == TokenKind::kDot;
      return text.kind(i) == TokenKind::kDot || text.kind(i) == TokenKind::kRange ||
             is_keyword(text.kind(i)) || (number && !adjacent(text, i));
    }
    case TokenKind::kTypePrefix:  // `INT#5`, `INT#-5`
      if (ends_operand(text.kind(i)) || text.kind(i) == TokenKind::kMinus ||
          text.kind(i) == TokenKind::kPlus) {
        return !adjacent(text, i);
      }
      break;
    default:
      break;
  }
  switch (text.kind(i)) {
    case TokenKind::kSemicolon:
      return before == TokenKind::kColon;
    case TokenKind::kComma:
    case TokenKind::kRightParen:
    case TokenKind::kRightBracket:
      return false;
    case TokenKind::kRange:
      return false;
    case TokenKind::kCaret:
      return !ends_operand(before);
    case TokenKind::kDot:
      return blank_before_dot(text, i, first);
    case TokenKind::kLeftParen:
    case TokenKind::kLeftBracket:
      return blank_before_bracket(text, line, i, first);
    case TokenKind::kColon:
      return blank_before_colon(line, i);
    case TokenKind::kEqual:
      return !is_set_assignment(text, i);
    default:
      break;
  }
  // A sign stays with its operand, except where the two would become one literal.
  bool operand = ends_operand(text.kind(i)) || text.kind(i) == TokenKind::kTypePrefix;
  if (!operand || !is_sign(text, i - 1, first)) return true;
  return i >= first + 2 && text.kind(i - 2) == TokenKind::kTypePrefix && !adjacent(text, i);
}

bool is_and_not(const Text& text, uint32_t i, uint32_t end) {
  return text.kind(i) == TokenKind::kAmpersand && i + 2 < end && text.is_word(i + 1, "N") &&
         text.end(i) == text.begin(i + 1) && text.kind(i + 2) != TokenKind::kRightParen;
}

Binding binding(const Text& text, uint32_t i, uint32_t first) {
  switch (text.kind(i)) {
    case TokenKind::kAssign:
    case TokenKind::kAttempt:
    case TokenKind::kArrow:
      return Binding::kAssign;
    case TokenKind::kComma:
      return Binding::kComma;
    case TokenKind::kOr:
    case TokenKind::kOrElse:
      return Binding::kOr;
    case TokenKind::kXor:
      return Binding::kXor;
    case TokenKind::kAnd:
    case TokenKind::kAndThen:
    case TokenKind::kAmpersand:
      return Binding::kAnd;
    case TokenKind::kEqual:
      return is_set_assignment(text, i) ? Binding::kAssign : Binding::kCompare;
    case TokenKind::kNotEqual:
    case TokenKind::kLess:
    case TokenKind::kLessEqual:
    case TokenKind::kGreater:
    case TokenKind::kGreaterEqual:
      return Binding::kCompare;
    case TokenKind::kPlus:
    case TokenKind::kMinus:
      return is_sign(text, i, first) ? Binding::kNone : Binding::kAdd;
    case TokenKind::kStar:
    case TokenKind::kSlash:
    case TokenKind::kMod:
      return Binding::kMultiply;
    case TokenKind::kPower:
      return Binding::kPower;
    default:
      return Binding::kNone;
  }
}

GroupKind group_kind(const Text& text, uint32_t open, uint32_t close, uint32_t first) {
  TokenKind before = open == first ? TokenKind::kSemicolon : text.kind(open - 1);
  bool behind_operand = ends_operand(before);
  if (text.kind(open) == TokenKind::kLeftBracket) {
    return behind_operand || before == TokenKind::kArray ? GroupKind::kIndex : GroupKind::kList;
  }
  if (behind_operand || before == TokenKind::kColon) return GroupKind::kList;
  // `(a := 1, b := 2)` is the value of a structure.
  if (open + 2 < close && text.kind(open + 2) == TokenKind::kAssign) return GroupKind::kList;
  return GroupKind::kParen;
}

}  // namespace frontend::formatting
