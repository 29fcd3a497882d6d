// The lexer over arbitrary bytes, with and without conditional compilation: no crash, no hang,
// tokens in order and inside the file. What conditions leave out only takes tokens away.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/check.h"
#include "frontend/lex/declaration_index.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/pragma.h"

namespace {

void check_list(const frontend::TokenList& list, size_t size) {
  size_t end = 0;
  for (const frontend::Token& token : list.tokens) {
    base::check(token.begin >= end, "tokens are in order and do not overlap");
    end = static_cast<size_t>(token.begin) + token.length;
    base::check(end <= size, "a token ends inside its file");
  }
  base::check(list.tokens.back().kind == frontend::TokenKind::kEnd, "the list ends with kEnd");
  size_t last = 0;
  for (base::SourceSpan span : list.pragmas) {
    base::check(span.begin.offset >= last && span.end.offset <= size, "pragmas are in order");
    last = span.end.offset;
  }
}

void check_attributes(const base::SourceMap& sources, const frontend::TokenList& list) {
  for (base::SourceSpan span : list.pragmas) {
    std::string_view text =
        sources.text(0).substr(span.begin.offset, span.end.offset - span.begin.offset);
    if (auto attribute = frontend::read_attribute(text)) {
      base::check(!attribute->name.empty(), "an attribute has a name");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(reinterpret_cast<const char*>(data), size));
  frontend::DeclarationIndex declarations(sources);
  frontend::LexOptions options;
  options.defines = {"A", "TARGET=arm"};
  options.declarations = &declarations;
  base::Diagnostics diagnostics;
  frontend::TokenList some = frontend::lex(sources, 0, diagnostics, options);
  frontend::TokenList all =
      frontend::lex(sources, 0, diagnostics, frontend::LexOptions::all_text());
  check_list(some, size);
  check_list(all, size);
  check_attributes(sources, all);
  frontend::print_tokens(all, sources);
  return 0;
}
