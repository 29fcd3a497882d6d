#include "frontend/lex/active_text.h"

#include "frontend/lex/pragma.h"

namespace frontend {
namespace {

bool is_condition(std::string_view pragma) {
  const PragmaReader reader(inside_pragma(pragma));
  return reader.is_word("IF") || reader.is_word("ELSIF") || reader.is_word("ELSE") ||
         reader.is_word("END_IF");
}

// Or seems to.
bool has_conditions(std::string_view text) {
  for (size_t at = text.find('{'); at != std::string_view::npos; at = text.find('{', at + 1)) {
    if (PragmaReader(text.substr(at + 1)).is_word("IF")) return true;
  }
  return false;
}

}  // namespace

std::optional<std::string> active_text(const base::SourceMap& sources, uint32_t file,
                                       const LexOptions& options) {
  const std::string_view text = sources.text(file);
  if (!has_conditions(text)) return std::nullopt;
  std::string out(text);
  base::Diagnostics unheard;
  const TokenList list = lex(sources, file, unheard, options);
  const uint32_t base = sources.begin(file).offset;
  const auto slice = [&](base::SourceSpan span) {
    return text.substr(span.begin.offset - base, span.end.offset - span.begin.offset);
  };
  uint32_t end = 0;  // of the token before
  size_t active = 0;
  for (const Token& token : list.tokens) {
    const uint32_t next = token.begin - base;
    base::SourceSpan left_out;
    const std::string_view gap = text.substr(end, next - end);
    if (gap.find('{') != std::string_view::npos) {
      for (const base::SourceSpan& pragma : lex(gap, {base + end}, unheard).pragmas) {
        if (!is_condition(slice(pragma))) continue;
        if (!left_out.begin.valid()) left_out.begin = pragma.begin;
        left_out.end = pragma.end;
      }
    }
    for (uint32_t at = left_out.begin.offset; left_out.begin.valid() && at < left_out.end.offset;) {
      while (active < list.pragmas.size() && list.pragmas[active].end.offset <= at) ++active;
      const bool in_pragma =
          active < list.pragmas.size() && list.pragmas[active].begin.offset <= at;
      if (in_pragma && !is_condition(slice(list.pragmas[active]))) {
        at = list.pragmas[active].end.offset;
        continue;
      }
      char& c = out[at - base];
      if (c != '\n' && c != '\r') c = ' ';
      ++at;
    }
    end = next + token.length;
  }
  return out;
}

}  // namespace frontend
