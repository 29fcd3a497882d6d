#include "frontend/warning_pragmas.h"

#include <map>
#include <optional>

#include "frontend/lex/declaration_index.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/pragma.h"
#include "ir/types/types.h"

namespace frontend {

namespace {

constexpr std::string_view kPragmaWord = "warning";

using Silent = std::optional<base::DiagnosticCode>;  // nullopt: every warning

// Most files have none; those are not lexed.
bool may_silence(std::string_view text) {
  for (size_t at = 0; (at = text.find('{', at)) != std::string_view::npos;) {
    at = text.find_first_not_of(" \t\r\n", at + 1);
    if (at == std::string_view::npos) return false;
    if (ir::same_name(text.substr(at, kPragmaWord.size()), kPragmaWord)) return true;
  }
  return false;
}

class FilePragmas {
 public:
  FilePragmas(base::WarningPolicy& policy, std::vector<base::Diagnostic>& mistakes)
      : policy_(policy), mistakes_(mistakes) {}

  void take(std::string_view inside, base::SourceSpan span) {
    PragmaReader reader(inside);
    if (!reader.accept_word(kPragmaWord)) return;
    const bool off = reader.is_word("off") || reader.is_word("disable");
    if (!off && !reader.is_word("restore")) {
      if (reader.kind() == PragmaReader::Kind::kText) return;  // {warning 'a text'}
      return mistake(span, "a pragma about warnings says `off` or `restore`",
                     "write {warning off W0003} ... {warning restore W0003}");
    }
    reader.next();
    if (reader.kind() == PragmaReader::Kind::kEnd) return apply(off, std::nullopt, span);
    while (reader.kind() == PragmaReader::Kind::kWord) {
      take_code(off, std::string(reader.piece()), span);
      reader.next();
      reader.accept_sign(',');
    }
    if (reader.kind() == PragmaReader::Kind::kEnd) return;
    mistake(span, "`" + std::string(reader.piece()) + "` is no code of a warning",
            "write codes as {warning off W0003, W0013}");
  }

  void end(base::SourcePos end) {
    for (const auto& [code, begin] : open_) policy_.silence(code, {begin, end});
  }

 private:
  void take_code(bool off, const std::string& text, base::SourceSpan span) {
    if (text[0] != 'W' && text[0] != 'E') return;  // of another compiler
    const Silent code = base::diagnostic_code(text);
    if (!code) {
      const std::string nearest = base::nearest_warning(text);
      return mistake(span, "`" + text + "` is no code of a warning",
                     nearest.empty() ? "`stc explain diagnostics` lists them"
                                     : "did you mean `" + nearest + "`?");
    }
    if (base::diagnostic_row(*code).severity == base::Severity::kError) {
      return mistake(span, "`" + text + "` is an error, and errors cannot be silenced",
                     "mend what it is about");
    }
    apply(off, code, span);
  }

  void apply(bool off, Silent code, base::SourceSpan span) {
    if (off) {
      open_.emplace(code, span.end);
      return;
    }
    if (!code) {
      if (open_.empty()) mistake(span, "no warning is silenced here", "remove this pragma");
      end(span.begin);
      return open_.clear();
    }
    const auto found = open_.find(code);
    if (found == open_.end()) {
      const std::string name(base::diagnostic_row(*code).code);
      return mistake(span, "`" + name + "` is not silenced here",
                     "write {warning off " + name + "} before it");
    }
    policy_.silence(code, {found->second, span.begin});
    open_.erase(found);
  }

  void mistake(base::SourceSpan span, std::string text, std::string fix) {
    mistakes_.push_back({base::DiagnosticCode::kWarningPragma,
                         span,
                         std::move(text),
                         std::move(fix),
                         {},
                         base::Severity::kWarning});
  }

  base::WarningPolicy& policy_;
  std::vector<base::Diagnostic>& mistakes_;
  std::map<Silent, base::SourcePos> open_;
};

}  // namespace

std::vector<base::Diagnostic> silence_warnings(const base::SourceMap& sources,
                                               const CompileOptions& options,
                                               base::WarningPolicy& policy) {
  policy.clear_silenced();
  std::vector<base::Diagnostic> mistakes;
  const DeclarationIndex declarations(sources);
  LexOptions lexing;
  lexing.defines = options.defines;
  lexing.declarations = &declarations;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    if (!sources.is_source(file) || !may_silence(sources.text(file))) continue;
    base::Diagnostics unheard(0);
    FilePragmas pragmas(policy, mistakes);
    const base::SourcePos begin = sources.begin(file);
    const std::string_view text = sources.text(file);
    for (const base::SourceSpan& span : lex(sources, file, unheard, lexing).pragmas) {
      const std::string_view pragma =
          text.substr(span.begin.offset - begin.offset, span.end.offset - span.begin.offset);
      pragmas.take(inside_pragma(pragma), span);
    }
    pragmas.end({begin.offset + static_cast<uint32_t>(text.size())});
  }
  return mistakes;
}

}  // namespace frontend
