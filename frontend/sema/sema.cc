#include "frontend/sema/sema.h"

namespace frontend {

Sema::Sema(const base::SourceMap& source_map, const Tree& syntax, uint32_t library_file,
           const CompileOptions& compile_options, Purpose purpose, base::Diagnostics& diagnostics)
    : sources(source_map),
      tree(syntax),
      options(compile_options),
      library(source_map, library_file),
      facts(syntax),
      diagnostics_(diagnostics),
      follow_ups_(source_map, syntax, diagnostics),
      purpose_(purpose) {
  program.name = options.name;
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  program.globals = program.types.declare(std::move(globals));
}

void Sema::mark_used(VarId id) {
  declared.variables[id.index].used = true;
  if (log != nullptr) log->marks.push_back(2 * id.index);
}

void Sema::mark_written(VarId id) {
  declared.variables[id.index].written = true;
  if (log != nullptr) log->marks.push_back(2 * id.index + 1);
}

// The place of a name that could have been meant where nothing has the one that is written: perhaps
// the mistake is there.
base::SourceSpan Sema::declared_at(DiagnosticCode code, std::string_view name) const {
  const auto variable = [&](const NameMap<VarId>& names) -> const Name* {
    const auto found = names.find(name);
    return found == names.end() ? nullptr : &declared.variables[found->second.index].name;
  };
  const Name* place = nullptr;
  if (code == DiagnosticCode::kUnknownName) {
    if (scope_.pou != nullptr) place = variable(scope_.pou->names);
    for (uint32_t at = objects.block_of(scope_.number()); place == nullptr && at != kNoPou;) {
      place = variable(declared.pous[at].names);
      at = declared.pous[at].base;
    }
    if (place == nullptr) place = variable(declared.globals);
  } else if (code == DiagnosticCode::kUnknownType) {
    const auto found = declared.types.find(name);
    for (const TypeDecl& decl : tree.types) {
      if (found != declared.types.end() && decl.spec == found->second) place = &decl.name;
    }
  } else if (code != DiagnosticCode::kUnknownProgram) {
    return {};
  }
  const PouInfo* const pou = place == nullptr ? declared.find_pou(name) : nullptr;
  if (pou != nullptr) place = &pou->decl->name;
  return place == nullptr || library.holds(place->span) ? base::SourceSpan() : place->span;
}

void Sema::error(DiagnosticCode code, base::SourceSpan span, std::string text, Fix fix) {
  const PouDecl* within = scope_.pou == nullptr ? nullptr : scope_.pou->decl;
  if (within != nullptr && scope_.pou->owner != kNoPou) {
    within = declared.pous[scope_.pou->owner].decl;
  }
  if (follow_ups_.silences(code, within, text)) return;
  base::Diagnostic message{code, span, std::move(text), std::move(fix.text), {}};
  const base::SourceSpan meant =
      fix.name.empty() ? base::SourceSpan() : declared_at(code, fix.name);
  if (meant.begin.valid()) {
    message.notes.push_back({meant, "`" + fix.name + "` is declared here"});
  }
  diagnostics_.add(std::move(message));
}

void Sema::warning(DiagnosticCode code, base::SourceSpan span, std::string text, std::string fix) {
  if (library.holds(span)) return;
  diagnostics_.add(code, span, std::move(text), std::move(fix));
}

void Sema::allow_extension(std::string_view what, base::SourceSpan span, std::string fix) {
  if (options.dialect != Dialect::kIec || library.holds(span)) return;
  error(DiagnosticCode::kExtension, span, std::string(what) + " is no part of the standard",
        std::move(fix));
}

// A conversion that exists: ranges are checked wherever a value gets into one.
std::string Sema::conversion_fix(ir::TypeId to) const {
  const bool enumeration = is_enum(program.types, to);
  if (enumeration && options.dialect == Dialect::kIec) return "choose the literal with CASE";
  const ir::TypeId type = enumeration ? to : without_range(program.types, to);
  return "convert it explicitly, for example with TO_" + type_text(type);
}

bool Sema::allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
  std::string text =
      "`" + type_text(from) + "` does not fit into `" + type_text(to) + "` without loss";
  const std::string fix = conversion_fix(to);
  if (options.dialect == Dialect::kIec) {
    error(DiagnosticCode::kTypeMismatch, span, text, fix);
    return false;
  }
  warning(DiagnosticCode::kImplicitNarrowing, span, text, fix);
  return true;
}

}  // namespace frontend
