// Which names are keywords. The table comes from tokens.def at compile time.
#pragma once

#include <string_view>

#include "frontend/lex/token.h"

namespace frontend {

// The keyword that `name` is, without regard to case; kName when it is none.
TokenKind keyword(std::string_view name);

}  // namespace frontend
