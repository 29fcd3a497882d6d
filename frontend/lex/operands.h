// Tokens that operands of expressions are made of, for whatever reads or writes text by tokens:
// the parser of instruction lists, the formatter, the import of XML.
#pragma once

#include "frontend/lex/token.h"

namespace frontend {

// Can it be a whole operand: a literal, an address or a name?
constexpr bool is_operand_word(TokenKind kind) {
  switch (kind) {
    case TokenKind::kInteger:
    case TokenKind::kReal:
    case TokenKind::kString:
    case TokenKind::kWideString:
    case TokenKind::kDuration:
    case TokenKind::kDate:
    case TokenKind::kDirect:
    case TokenKind::kTrue:
    case TokenKind::kFalse:
      return true;
    default:
      return is_name(kind);
  }
}

// Can an operand end with it?
constexpr bool ends_operand(TokenKind kind) {
  return is_operand_word(kind) || kind == TokenKind::kRightParen ||
         kind == TokenKind::kRightBracket || kind == TokenKind::kCaret;
}

}  // namespace frontend
