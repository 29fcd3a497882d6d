#include "frontend/parse/il_operators.h"

#include <algorithm>

#include "frontend/lex/operands.h"
#include "frontend/parse/token_sets.h"
#include "ir/types/types.h"

namespace frontend {
namespace {

constexpr IlOperator plain(std::string_view word, IlAction action) { return {word, action}; }
constexpr IlOperator binary(std::string_view word, BinaryOp op, bool negated = false) {
  return {word, IlAction::kBinary, op, negated};
}
constexpr IlOperator conditional(std::string_view word, IlAction action, bool negated) {
  return {word, action, BinaryOp::kAnd, negated, true};
}

constexpr IlOperator kIlOperators[] = {
    plain("LD", IlAction::kLoad),
    {"LDN", IlAction::kLoad, BinaryOp::kAnd, true},
    plain("ST", IlAction::kStore),
    {"STN", IlAction::kStore, BinaryOp::kAnd, true},
    plain("S", IlAction::kSet),
    plain("R", IlAction::kSet),
    plain("S1", IlAction::kInput),
    plain("R1", IlAction::kInput),
    plain("CU", IlAction::kInput),
    plain("CD", IlAction::kInput),
    plain("CLK", IlAction::kInput),
    plain("IN", IlAction::kInput),
    plain("PT", IlAction::kValue),
    plain("PV", IlAction::kValue),
    binary("AND", BinaryOp::kAnd),
    binary("ANDN", BinaryOp::kAnd, true),
    binary("&", BinaryOp::kAnd),
    binary("&N", BinaryOp::kAnd, true),
    binary("OR", BinaryOp::kOr),
    binary("ORN", BinaryOp::kOr, true),
    binary("XOR", BinaryOp::kXor),
    binary("XORN", BinaryOp::kXor, true),
    plain("NOT", IlAction::kNot),
    binary("ADD", BinaryOp::kAdd),
    binary("SUB", BinaryOp::kSub),
    binary("MUL", BinaryOp::kMul),
    binary("DIV", BinaryOp::kDiv),
    binary("MOD", BinaryOp::kMod),
    binary("GT", BinaryOp::kGt),
    binary("GE", BinaryOp::kGe),
    binary("EQ", BinaryOp::kEq),
    binary("NE", BinaryOp::kNe),
    binary("LE", BinaryOp::kLe),
    binary("LT", BinaryOp::kLt),
    plain("JMP", IlAction::kJump),
    conditional("JMPC", IlAction::kJump, false),
    conditional("JMPCN", IlAction::kJump, true),
    plain("CAL", IlAction::kCall),
    conditional("CALC", IlAction::kCall, false),
    conditional("CALCN", IlAction::kCall, true),
    plain("RET", IlAction::kReturn),
    conditional("RETC", IlAction::kReturn, false),
    conditional("RETCN", IlAction::kReturn, true),
};

bool begins_operand(TokenKind kind) {
  return is_operand_word(kind) || kind == TokenKind::kTypePrefix || kind == TokenKind::kMinus ||
         kind == TokenKind::kPlus;
}

// Is one of the two the other with a letter changed, added or left out?
bool one_letter_apart(std::string_view a, std::string_view b) {
  if (a.size() < b.size()) std::swap(a, b);
  if (a.size() > b.size() + 1) return false;
  size_t same = 0;
  while (same < b.size() && ir::same_name(a.substr(same, 1), b.substr(same, 1))) ++same;
  size_t rest = a.size() == b.size() && same < b.size() ? same + 1 : same;
  return ir::same_name(a.substr(std::min(same + 1, a.size())), b.substr(rest));
}

}  // namespace

std::span<const IlOperator> il_operators() { return kIlOperators; }

const IlOperator* find_il_operator(std::string_view word) {
  constexpr size_t kLongest = 5;
  if (word.size() > kLongest) return nullptr;
  for (const IlOperator& op : kIlOperators) {
    if (ir::same_name(op.word, word)) return &op;
  }
  return nullptr;
}

const IlOperator* similar_il_operator(std::string_view word) {
  if (word.size() < 2) return nullptr;
  for (const IlOperator& op : kIlOperators) {
    if (op.word.size() > 1 && one_letter_apart(op.word, word)) return &op;
  }
  return nullptr;
}

bool IlTokens::begins_row(size_t i) const {
  if (i == 0) return true;
  uint32_t from = at(i - 1).begin + at(i - 1).length - base;
  return text.substr(from, at(i).begin - base - from).find('\n') != std::string_view::npos;
}

bool IlTokens::is_instruction(size_t i) const {
  const IlOperator* op = find_il_operator(word(i));
  if (op == nullptr) return false;
  const Token& next = at(i + 1);
  bool alone = op->action == IlAction::kReturn || op->action == IlAction::kNot;
  if (alone && !rows_count) return is_name(next.kind) || is_statement_boundary(next.kind);
  if (alone) return next.kind == TokenKind::kEnd || begins_row(i + 1);
  if (rows_count && begins_row(i + 1)) return false;
  if (op->action == IlAction::kBinary && next.kind == TokenKind::kLeftParen) return true;
  // `r REF= x;` and `JMP done;` are Structured Text.
  const Token& third = at(i + 2);
  if (third.kind == TokenKind::kEqual) return false;
  if (op->action == IlAction::kJump && third.kind == TokenKind::kSemicolon) return false;
  return begins_operand(next.kind);
}

bool IlTokens::is_instruction_list(size_t i) const {
  while (is_name(at(i).kind) && at(i + 1).kind == TokenKind::kColon) i += 2;
  if (is_instruction(i) && at(i + 1).kind != TokenKind::kLeftParen) return true;
  if (is_statement_boundary(at(i).kind) || (rows_count && !is_name(at(i).kind))) return false;
  constexpr size_t kLongestCall = 400;  // tokens
  uint32_t depth = 0;
  for (size_t next = i + 1; next < count && next < i + kLongestCall; ++next) {
    TokenKind kind = at(next).kind;
    if (depth == 0 && (!rows_count || begins_row(next)) && is_instruction(next)) return true;
    if (kind == TokenKind::kLeftParen) ++depth;
    if (kind == TokenKind::kRightParen && depth > 0) --depth;
    if (is_statement_boundary(kind) || kind == TokenKind::kSemicolon ||
        (depth == 0 && kind == TokenKind::kAssign))
      return false;
  }
  return false;
}

}  // namespace frontend
