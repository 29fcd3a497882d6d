#include "frontend/sema/sema.h"

namespace frontend {

Sema::Sema(const base::SourceMap& source_map, const Tree& syntax, uint32_t library_file,
           const CompileOptions& compile_options, base::Diagnostics& diagnostics)
    : sources(source_map),
      tree(syntax),
      options(compile_options),
      diagnostics_(diagnostics),
      library_file_(library_file),
      specs_(syntax.specs.size()),
      notes_(syntax.exprs.size()) {
  program.name = options.name;
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  program.globals = program.types.declare(std::move(globals));
  for (const stdlib::FunctionRow& row : stdlib::function_rows()) standard_.emplace(row.name, &row);
}

void Sema::error(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix) {
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

void Sema::warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix) {
  if (span.begin.valid() && sources.file_of(span.begin) >= library_file_) return;
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

bool Sema::allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
  std::string text =
      "`" + type_text(from) + "` does not fit into `" + type_text(to) + "` without loss";
  std::string fix = "say it explicitly, for example with TO_" + type_text(to);
  if (options.dialect == Dialect::kIec) {
    error(DiagnosticCode::kTypeMismatch, span, text, fix);
    return false;
  }
  warning(DiagnosticCode::kImplicitNarrowing, span, text, fix);
  return true;
}

}  // namespace frontend
