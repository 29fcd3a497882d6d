// What a text parses to: its tree as text, and its messages as "line:column code" or in full.
#pragma once

#include <string>

#include "base/diagnostics.h"
#include "base/limits.h"
#include "frontend/parse/parse.h"

namespace frontend::test {

struct Parsed {
  base::SourceMap sources;
  base::Diagnostics diagnostics;
  Tree tree;
  std::string text;   // print(tree)
  std::string codes;  // "2:5 E1002\n" per message
};

inline Parsed parse_text(const std::string& source) {
  Parsed out;
  out.sources.add("t.st", source);
  parse(out.sources, 0, out.tree, out.diagnostics);
  out.diagnostics.sort();
  out.text = print(out.tree);
  for (const base::Diagnostic& d : out.diagnostics.all()) {
    base::SourceLocation at = out.sources.locate(d.span.begin);
    out.codes += std::to_string(at.line) + ':' + std::to_string(at.column) + ' ' +
                 std::string(base::diagnostic_row(d.code).code) + '\n';
  }
  return out;
}

inline std::string messages(const Parsed& parsed) {
  return base::render(parsed.diagnostics, parsed.sources, base::DiagnosticFormat::kText, false);
}

// The one expression of `x := <source>;`.
inline std::string expression(const std::string& source) {
  Parsed parsed = parse_text("PROGRAM p x := " + source + "; END_PROGRAM");
  if (!parsed.codes.empty()) return messages(parsed);
  std::string head = "PROGRAM p\n  x := ";
  return parsed.text.substr(head.size(), parsed.text.size() - head.size() - 1);
}

// The statements of a program, without errors.
inline std::string statements(const std::string& source) {
  Parsed parsed = parse_text("PROGRAM p\n" + source + "\nEND_PROGRAM");
  if (!parsed.codes.empty()) return messages(parsed);
  return parsed.text.substr(std::string("PROGRAM p\n").size());
}

// The declarations of a file, without errors.
inline std::string declarations(const std::string& source) {
  Parsed parsed = parse_text(source);
  return parsed.codes.empty() ? parsed.text : messages(parsed);
}

inline std::string codes(const std::string& source) { return parse_text(source).codes; }

}  // namespace frontend::test
