#include "adapters/xml/operand.h"

#include <algorithm>
#include <string>
#include <vector>

#include "adapters/xml/document.h"
#include "base/name_case.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/operands.h"

namespace xml {
namespace {

using frontend::ends_operand;
using frontend::is_operand_word;
using frontend::Token;
using frontend::TokenKind;

bool is_operator_word(TokenKind kind) {
  return kind == TokenKind::kAnd || kind == TokenKind::kAndThen || kind == TokenKind::kMod ||
         kind == TokenKind::kNot || kind == TokenKind::kOr || kind == TokenKind::kOrElse ||
         kind == TokenKind::kXor;
}

// May an operand begin with it?
bool begins(TokenKind kind) {
  return is_operand_word(kind) || kind == TokenKind::kNot || kind == TokenKind::kLeftParen ||
         kind == TokenKind::kTypePrefix || kind == TokenKind::kMinus || kind == TokenKind::kPlus;
}

// `P a`, `[/ a]` and `JMP a` mean something else where text of a network is read.
bool may_follow(TokenKind before, TokenKind kind) {
  if (kind == TokenKind::kLeftBracket) return ends_operand(before);
  const bool starts =
      is_operand_word(kind) || kind == TokenKind::kTypePrefix || kind == TokenKind::kNot;
  return !(starts && ends_operand(before));
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

}  // namespace

bool is_operand(std::string_view text) {
  base::Diagnostics diagnostics;
  const std::vector<Token> tokens = frontend::lex(text, {0}, diagnostics).tokens;
  if (diagnostics.has_errors() || !begins(tokens[0].kind)) return false;
  if (tokens.size() == 2 && text.substr(tokens[0].begin, tokens[0].length) == "_") return false;
  std::string open;  // brackets
  size_t end = 0;    // of the token before
  for (size_t i = 0; i < tokens.size(); ++i) {
    const TokenKind kind = tokens[i].kind;
    const size_t begin = kind == TokenKind::kEnd ? text.size() : tokens[i].begin;
    if (!is_blank(text.substr(end, begin - end))) return false;  // comments and pragmas
    end = begin + tokens[i].length;
    if (i > 0 && !may_follow(tokens[i - 1].kind, kind)) return false;
    if (kind == TokenKind::kEnd) break;
    if (frontend::is_keyword(kind) && !is_operator_word(kind) && !is_operand_word(kind))
      return false;
    const bool inside_only = kind == TokenKind::kComma || kind == TokenKind::kAssign ||
                             kind == TokenKind::kArrow || kind == TokenKind::kRange;
    if (inside_only && open.empty()) return false;
    if (kind == TokenKind::kSemicolon || kind == TokenKind::kColon || kind == TokenKind::kAttempt) {
      return false;
    }
    if (kind == TokenKind::kLeftParen) open += ')';
    if (kind == TokenKind::kLeftBracket) open += ']';
    if (kind != TokenKind::kRightParen && kind != TokenKind::kRightBracket) continue;
    if (open.empty() || open.back() != (kind == TokenKind::kRightParen ? ')' : ']')) return false;
    open.pop_back();
  }
  return open.empty();
}

bool is_plain_operand(std::string_view text) {
  return text.find('(') == std::string_view::npos && is_operand(text);
}

bool is_dotted_name(std::string_view text) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('.'), text.size());
    if (!is_name(text.substr(0, end)) || end + 1 == text.size()) return false;
    text.remove_prefix(std::min(end + 1, text.size()));
    if (text.empty()) return true;
  }
  return false;
}

bool is_literal(std::string_view operand) {
  if (operand.empty() || base::same_name(operand, "TRUE") || base::same_name(operand, "FALSE"))
    return true;
  const char quote = operand[0];
  if (quote == '\'' || quote == '"') return operand.find(quote, 1) == operand.size() - 1;
  const bool one = std::all_of(operand.begin(), operand.end(), [](char c) {
    return c == '#' || c == '.' || c == ':' || is_name("_" + std::string(1, c));
  });
  const bool digit = operand[0] >= '0' && operand[0] <= '9';
  return one && (digit || operand.find('#') != std::string_view::npos);
}

}  // namespace xml
