// What stands between LADDER and END_LADDER, FBD and END_FBD. Ladder is read and drawn again; rows
// of FBD are laid out as statements are, and keep their comments where they stand.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "frontend/format/format.h"
#include "frontend/lex/token.h"

namespace frontend::formatting {

// `head`: kLadder or kFbd. Rows that begin in column `indent`, without a line end after the last.
// nullopt when the text has errors, cannot be drawn by ladder/read.h's rules (a tap inside of a
// branch), or says stc:off: it stays as it is.
std::optional<std::string> drawn(TokenKind head, std::string_view text, uint32_t indent,
                                 const FormatOptions& options);

// Do both texts mean the same, with the same comments?
bool same_diagram(TokenKind head, std::string_view a, std::string_view b);

// Is token `end` the end of a diagram that the token in front of it begins?
constexpr bool ends_diagram(TokenKind head, TokenKind end) {
  return (head == TokenKind::kLadder && end == TokenKind::kEndLadder) ||
         (head == TokenKind::kFbd && end == TokenKind::kEndFbd);
}

}  // namespace frontend::formatting
