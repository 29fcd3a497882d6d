#include "base/diagnostics_render.h"
#include "frontend/lex/lexer.h"

namespace frontend {

std::string print_tokens(const TokenList& list, const base::SourceMap& sources) {
  std::string out;
  if (list.tokens.empty()) return out;
  uint32_t file = sources.file_of({list.tokens.front().begin});
  std::string_view text = sources.text(file);
  uint32_t base = sources.begin(file).offset;
  for (const Token& token : list.tokens) {
    base::SourceLocation at = sources.locate({token.begin});
    out += std::to_string(at.line) + ':' + std::to_string(at.column) + ' ';
    bool word = is_keyword(token.kind) || token.kind > kFirstSoft;
    out += is_keyword(token.kind) ? "keyword" : word ? "soft keyword" : token_text(token.kind);
    if (token.length != 0 && (word || token.kind < TokenKind::kLeftParen)) {
      out += ' ' + base::printable(text.substr(token.begin - base, token.length));
    }
    out += '\n';
  }
  return out;
}

}  // namespace frontend
