// A token: what it is and where. Twelve bytes, owns nothing; its text is a view
// into the SourceMap. Literals are decoded later, when the parser needs the value.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/source.h"

namespace frontend {

enum class TokenKind : uint8_t {
#define TOKEN(id, text) id,
#define KEYWORD(id, text) id,
#define SOFT(id, text) id,
#include "frontend/lex/tokens.def"
};

// "IF", ":=", "name": how messages and dumps call a kind.
std::string_view token_text(TokenKind kind);

inline constexpr TokenKind kFirstKeyword = TokenKind::kAnd;
inline constexpr TokenKind kFirstSoft = TokenKind::kAbstract;

// A word that never is a name.
constexpr bool is_keyword(TokenKind kind) { return kind >= kFirstKeyword && kind < kFirstSoft; }
// A name, or a soft keyword, which is a name wherever the grammar does not ask for it.
constexpr bool is_name(TokenKind kind) { return kind == TokenKind::kName || kind >= kFirstSoft; }

constexpr bool is_access(TokenKind kind) {
  return kind == TokenKind::kPublic || kind == TokenKind::kPrivate ||
         kind == TokenKind::kProtected || kind == TokenKind::kInternal;
}

// GET, PRIVATE and the like are names in a statement where this comes after them.
constexpr bool follows_a_name(TokenKind next) {
  return next == TokenKind::kAssign || next == TokenKind::kDot || next == TokenKind::kLeftParen ||
         next == TokenKind::kLeftBracket || next == TokenKind::kCaret || next == TokenKind::kEqual;
}

struct Token {
  uint32_t begin = 0;  // SourcePos offset
  uint32_t length = 0;
  TokenKind kind = TokenKind::kEnd;

  base::SourceSpan span() const { return {{begin}, {begin + length}}; }
};

}  // namespace frontend
