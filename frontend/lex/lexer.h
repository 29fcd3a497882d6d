// Bytes -> tokens. Hand-written, one pass, no allocation per token. Any bytes
// are accepted: what the language does not know gets a diagnostic and is
// skipped. Comments and white space vanish; pragmas are kept as spans.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/lex/token.h"

namespace frontend {

struct TokenList {
  std::vector<Token> tokens;              // never empty: the last one is kEnd
  std::vector<base::SourceSpan> pragmas;  // `{...}` in source order
};

TokenList lex(const base::SourceMap& sources, uint32_t file, base::Diagnostics& diagnostics);

// One line per token, "line:column kind text", for `stc dump --tokens` and golden tests.
std::string print_tokens(const TokenList& list, const base::SourceMap& sources);

}  // namespace frontend
