// Typical mistakes of people, put into a valid program one at a time: what comes out, and where
// the mistake is. The original is cut by the compiler's own tokens, so a mistake is never in a
// comment.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "frontend/lex/lexer.h"

namespace mistakes {

struct Mistaken {
  std::string text;
  uint32_t at = 0;  // offset in the text
};

struct Original {
  std::string text;
  std::vector<frontend::Token> tokens;
  std::string_view word(size_t token) const {
    return std::string_view(text).substr(tokens[token].begin, tokens[token].length);
  }
  frontend::TokenKind kind(size_t token) const {
    return token < tokens.size() ? tokens[token].kind : frontend::TokenKind::kEnd;
  }
};

struct Operator {
  const char* name;  // "delete ;"
  // Is there such a mistake to make at this token, and what does it look like?
  std::function<bool(const Original&, size_t token)> applies;
  std::function<std::string(const Original&, size_t token)> replacement;
};

const std::vector<Operator>& operators();
Mistaken apply(const Operator& op, const Original& original, size_t token);
Original read(std::string text);

}  // namespace mistakes
