// Lexer and parser over arbitrary bytes: no crash, no hang, every position inside
// its file, every tree printable. libFuzzer calls LLVMFuzzerTestOneInput; without
// it, corpus_main.cc replays and mutates a corpus by seed.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/check.h"
#include "base/limits.h"
#include "frontend/lex/lexer.h"
#include "frontend/parse/parse.h"

namespace {

void check_tokens(const frontend::TokenList& list, size_t size) {
  size_t end = 0;
  for (const frontend::Token& token : list.tokens) {
    base::check(token.begin >= end, "tokens are in order and do not overlap");
    end = static_cast<size_t>(token.begin) + token.length;
    base::check(end <= size, "a token ends inside its file");
  }
  base::check(list.tokens.back().kind == frontend::TokenKind::kEnd, "the list ends with kEnd");
}

// What network.h promises of every reader.
void check_diagram(const frontend::network::Body& body) {
  for (const frontend::network::Network& network : body.networks) {
    for (const frontend::network::Element& element : network.elements) {
      for (const frontend::network::Input& input : element.inputs) {
        for (frontend::network::Link link : input.from) {
          base::check(link.element < network.elements.size(), "a link names an element");
          base::check(link.output < network.elements[link.element].outputs.size(),
                      "a link names an output");
        }
      }
    }
  }
}

void check_tree(const frontend::Tree& tree, size_t size) {
  for (const frontend::network::Body& body : tree.diagrams) check_diagram(body);
  tree.exprs.each([&](const frontend::Expr& expr) {
    base::check(expr.span.begin.offset <= size, "an expression begins inside its file");
    base::check(expr.height >= 1 && expr.height <= base::kMaxExpressionHeight, "height is limited");
  });
  base::check(tree.types.empty() || !frontend::print(tree).empty(), "a tree has a text");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(reinterpret_cast<const char*>(data), size));
  base::Diagnostics diagnostics;
  frontend::TokenList list = frontend::lex(sources, 0, diagnostics);
  check_tokens(list, size);
  frontend::print_tokens(list, sources);
  frontend::Tree tree;
  frontend::parse(sources, 0, tree, diagnostics);
  check_tree(tree, size);
  frontend::print(tree);
  diagnostics.sort();
  for (uint32_t format = 0; format <= static_cast<uint32_t>(base::DiagnosticFormat::kGithub);
       ++format) {
    base::render(diagnostics, sources, static_cast<base::DiagnosticFormat>(format), true);
  }
  return 0;
}
