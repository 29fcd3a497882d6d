#include "frontend/sema/sema.h"

namespace frontend {

Sema::Sema(const base::SourceMap& source_map, const Tree& syntax, uint32_t library_file,
           const CompileOptions& compile_options, Purpose purpose, base::Diagnostics& diagnostics)
    : sources(source_map),
      tree(syntax),
      options(compile_options),
      diagnostics_(diagnostics),
      follow_ups_(source_map, syntax, diagnostics),
      purpose_(purpose),
      library_file_(library_file),
      library_end_(source_map.file_count()),
      specs_(syntax.specs.size()),
      notes_(syntax.exprs.size()) {
  program.name = options.name;
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  program.globals = program.types.declare(std::move(globals));
  for (const stdlib::FunctionRow& row : stdlib::function_rows()) standard_.emplace(row.name, &row);
}

bool Sema::in_library(base::SourceSpan span) const {
  if (!span.begin.valid()) return false;
  const uint32_t file = sources.file_of(span.begin);
  return file >= library_file_ && file < library_end_;
}

void Sema::mark_used(VarId id) {
  variables_[id.index].used = true;
  if (log != nullptr) log->marks.push_back(2 * id.index);
}

void Sema::mark_written(VarId id) {
  variables_[id.index].written = true;
  if (log != nullptr) log->marks.push_back(2 * id.index + 1);
}

void Sema::error(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix) {
  const PouDecl* within = current_pou_ == kNoPou ? nullptr : pous[current_pou_].decl;
  if (within != nullptr && pous[current_pou_].owner != kNoPou) {
    within = pous[pous[current_pou_].owner].decl;
  }
  if (follow_ups_.silences(code, within, text)) return;
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

void Sema::warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix) {
  if (in_library(span)) return;
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

void Sema::allow_extension(std::string_view what, base::SourceSpan span, std::string fix) {
  if (options.dialect != Dialect::kIec || in_library(span)) return;
  error(DiagnosticCode::kExtension, span, std::string(what) + " is no part of the standard",
        std::move(fix));
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
