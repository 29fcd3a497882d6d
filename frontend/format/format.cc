#include "frontend/format/format.h"

#include <algorithm>

#include "base/limits.h"
#include "frontend/format/branches.h"
#include "frontend/format/diagrams.h"
#include "frontend/format/same_program.h"
#include "frontend/format/writer.h"
#include "frontend/parse/parse.h"
#include "ir/types/types.h"

namespace frontend {

namespace {

base::Error errors_in(const base::SourceMap& sources, uint32_t file, uint32_t count) {
  return {base::Refusal::kSourceErrors,
          std::string(sources.file_name(file)) + ": " + std::to_string(count) + " error(s)"};
}

// `{error}` is no reason to leave a text alone.
uint32_t copy_errors(const base::Diagnostics& from, base::Diagnostics& to) {
  uint32_t errors = 0;
  for (const base::Diagnostic& diagnostic : from.all()) {
    if (diagnostic.code == base::DiagnosticCode::kErrorPragma) continue;
    if (base::diagnostic_row(diagnostic.code).severity != base::Severity::kError) continue;
    to.add(diagnostic);
    ++errors;
  }
  return errors;
}

// A drawing that the lexer has left out although its end is missing: its first token, or the number
// of tokens.
uint32_t open_diagram(const base::SourceMap& sources, uint32_t file, const TokenList& tokens) {
  formatting::Text text(sources, file, tokens);
  for (uint32_t i = 1; i < text.token_count(); ++i) {
    if (formatting::ends_diagram(text.kind(i - 1), text.kind(i))) continue;
    const formatting::Gap& gap = text.gap(i);
    for (uint32_t p = gap.first; p < gap.first + gap.count; ++p) {
      if (text.piece(p).kind == formatting::PieceKind::kForeign) return i - 1;
    }
  }
  return text.token_count();
}

// What is no sound text in a branch that does not count, so that nobody else has said it.
bool report_open_branch(const base::SourceMap& sources, uint32_t file,
                        base::Diagnostics& diagnostics) {
  base::Diagnostics lexical;
  const TokenList tokens = lex(sources, file, lexical, LexOptions::all_text());
  const uint32_t open = formatting::open_in_branch(formatting::Text(sources, file, tokens));
  if (open >= tokens.tokens.size()) return false;
  diagnostics.add(
      base::DiagnosticCode::kUnclosedBracket, tokens.tokens[open].span(),
      "the branches of conditional compilation differ in the brackets that they leave open",
      "close each bracket in the branch that opens it");
  return true;
}

// Of a text that cannot be laid out and has such branches: what stands in them is to blame.
bool report_branches(const base::SourceMap& sources, uint32_t file,
                     base::Diagnostics& diagnostics) {
  base::Diagnostics lexical;
  const TokenList tokens = lex(sources, file, lexical, LexOptions::all_text());
  const formatting::Text text(sources, file, tokens);
  const uint32_t end = formatting::first_branch_end(text);
  if (end >= text.token_count()) return false;
  diagnostics.add(base::DiagnosticCode::kMissingEnd, tokens.tokens[end].span(),
                  "the branches of conditional compilation in front of this cannot be laid out "
                  "together: one begins or ends what the others do not",
                  "write whole rows, blocks of variables and POUs in each branch");
  return true;
}

std::string laid_out(const base::SourceMap& sources, uint32_t file, const TokenList& tokens,
                     const FormatOptions& options) {
  formatting::Text text(sources, file, tokens);
  formatting::Outline outline = formatting::outline(text, options.indent);
  formatting::Rows rows = formatting::Writer(text, outline, options).run();
  return formatting::align(rows, options, text);
}

}  // namespace

base::Result<std::string> format_tokens(const base::SourceMap& sources, uint32_t file,
                                        const FormatOptions& options,
                                        base::Diagnostics& diagnostics) {
  base::Diagnostics lexical;
  TokenList tokens = lex(sources, file, lexical, LexOptions::all_text());
  uint32_t errors = copy_errors(lexical, diagnostics);
  if (errors != 0) return errors_in(sources, file, errors);
  if (uint32_t open = open_diagram(sources, file, tokens); open < tokens.tokens.size()) {
    diagnostics.add(base::DiagnosticCode::kMissingEnd, tokens.tokens[open].span(),
                    "this drawing has no end", "write END_LADDER after it");
    return errors_in(sources, file, 1);
  }
  base::SourceMap result;
  result.add(std::string(sources.file_name(file)), laid_out(sources, file, tokens, options));
  base::Status same = formatting::same_program(sources, file, result, 0);
  if (same.ok()) return std::string(result.text(0));
  // A word that begins no drawing in its row would begin one in a row of its own.
  for (const Token& token : tokens.tokens) {
    if (token.kind != TokenKind::kLadder && token.kind != TokenKind::kFbd) continue;
    diagnostics.add(base::DiagnosticCode::kMissingEnd, token.span(), "this drawing has no end",
                    "write LADDER or FBD in a row of its own, and its end after it");
    return errors_in(sources, file, 1);
  }
  return same.error();
}

base::Result<std::string> format(const base::SourceMap& sources, uint32_t file,
                                 const FormatOptions& options, base::Diagnostics& diagnostics) {
  base::Diagnostics found;
  Tree tree;
  parse(sources, file, tree, found);
  uint32_t errors = copy_errors(found, diagnostics);
  if (errors != 0) return errors_in(sources, file, errors);
  auto formatted = format_tokens(sources, file, options, diagnostics);
  auto of_list = [](const auto& node) { return node.instruction; };
  bool rows_count =
      std::any_of(tree.stmts.begin(), tree.stmts.end(), of_list) || tree.exprs.any_of(of_list);
  if (!formatted.ok() || !rows_count) return formatted;
  if (report_open_branch(sources, file, diagnostics)) return errors_in(sources, file, 1);
  // The ends of rows are part of an instruction list, and no token shows them.
  base::SourceMap result;
  result.add(std::string(sources.file_name(file)), *formatted);
  base::Diagnostics other;
  Tree after;
  parse(result, 0, after, other);
  // Words of diagrams may change their case.
  if (ir::same_name(print(after), print(tree))) return formatted;
  if (report_branches(sources, file, diagnostics)) return errors_in(sources, file, 1);
  return base::Error{
      base::Refusal::kInternal,
      std::string(sources.file_name(file)) +
          ": formatting would have changed an instruction list or a diagram; the text was left "
          "as it is"};
}

}  // namespace frontend
