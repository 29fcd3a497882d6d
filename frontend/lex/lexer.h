// Bytes -> tokens. Hand-written, one pass, no allocation per token. Any bytes
// are accepted: what the language does not know gets a diagnostic and is
// skipped. Comments and white space vanish; pragmas are kept as spans. Text that
// `{IF ...}` leaves out gives no tokens and no messages.
#pragma once

#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/source.h"
#include "frontend/lex/token.h"

namespace frontend {

class DeclarationIndex;

struct TokenList {
  std::vector<Token> tokens;              // never empty: the last one is kEnd
  std::vector<base::SourceSpan> pragmas;  // `{...}` in source order, of active text
  bool latin1 = false;                    // not valid UTF-8: bytes above 0x7F are Latin-1
};

struct LexOptions {
  // False: pragmas of conditional compilation have no effect, all text is read.
  bool conditional = true;
  std::vector<std::string> defines;  // NAME or NAME=VALUE
  // Answers `defined(pou: X)` and the like; null: nothing is declared.
  const DeclarationIndex* declarations = nullptr;

  static LexOptions all_text() {
    LexOptions out;
    out.conditional = false;
    return out;
  }
};

TokenList lex(const base::SourceMap& sources, uint32_t file, base::Diagnostics& diagnostics,
              const LexOptions& options = {});

// The tokens of a piece of text that begins at `begin` of a SourceMap. Pragmas have no effect.
TokenList lex(std::string_view text, base::SourcePos begin, base::Diagnostics& diagnostics);

// One line per token, "line:column kind text", for `stc dump --tokens` and golden tests.
std::string print_tokens(const TokenList& list, const base::SourceMap& sources);

}  // namespace frontend
