#include "frontend/sema/reporter.h"

#include <utility>

#include "frontend/sema/types/conversion.h"

namespace frontend {

Reporter::Reporter(const base::SourceMap& sources, const Tree& tree, const CompileOptions& options,
                   const ir::Program& program, const Declarations& declared, const Library& library,
                   base::Diagnostics& diagnostics)
    : tree_(tree),
      options_(options),
      program_(program),
      declared_(declared),
      library_(library),
      diagnostics_(diagnostics),
      follow_ups_(sources, tree, diagnostics) {}

bool is_interface(const ir::TypeTable& types, ir::TypeId type) {
  return type.valid() && types[type].kind == ir::Kind::kRefTo &&
         types[types[type].base].kind == ir::Kind::kInterface;
}

std::string Reporter::type_text(ir::TypeId type) const {
  const ir::TypeTable& types = program_.types;
  return types.shown(is_interface(types, type) ? types[type].base : type);
}

// The place of a name that could have been meant where nothing has the one that is written: perhaps
// the mistake is there.
base::SourceSpan Reporter::declared_at(const PouScope& scope, DiagnosticCode code,
                                       std::string_view name) const {
  const auto variable = [&](const NameMap<VarId>& names) -> const Name* {
    const auto found = names.find(name);
    return found == names.end() ? nullptr : &declared_.variables[found->second.index].name;
  };
  const Name* place = nullptr;
  if (code == DiagnosticCode::kUnknownName) {
    if (scope.pou != nullptr) place = variable(scope.pou->names);
    for (uint32_t at = declared_.block_of(scope); place == nullptr && at != kNoPou;) {
      place = variable(declared_.pous[at].names);
      at = declared_.pous[at].base;
    }
    if (place == nullptr) place = variable(declared_.globals);
  } else if (code == DiagnosticCode::kUnknownType) {
    const auto found = declared_.types.find(name);
    for (const TypeDecl& decl : tree_.types) {
      if (found != declared_.types.end() && decl.spec == found->second) place = &decl.name;
    }
  } else if (code != DiagnosticCode::kUnknownProgram) {
    return {};
  }
  const PouInfo* const pou = place == nullptr ? declared_.find_pou(name) : nullptr;
  if (pou != nullptr) place = &pou->decl->name;
  return place == nullptr || library_.holds(place->span) ? base::SourceSpan() : place->span;
}

void Reporter::error(const PouScope& scope, DiagnosticCode code, base::SourceSpan span,
                     std::string text, Fix fix) {
  if (silenced_ != 0) return;
  const PouDecl* within = scope.pou == nullptr ? nullptr : scope.pou->decl;
  if (within != nullptr && scope.pou->owner != kNoPou) {
    within = declared_.pous[scope.pou->owner].decl;
  }
  if (follow_ups_.silences(code, within, text)) return;
  base::Diagnostic message{code, span, std::move(text), std::move(fix.text), {}};
  const base::SourceSpan meant =
      fix.name.empty() ? base::SourceSpan() : declared_at(scope, code, fix.name);
  if (meant.begin.valid()) {
    message.notes.push_back({meant, "`" + fix.name + "` is declared here"});
  }
  diagnostics_.add(std::move(message));
}

void Reporter::warning(DiagnosticCode code, base::SourceSpan span, std::string text,
                       std::string fix, std::vector<base::DiagnosticNote> notes) {
  if (silenced_ != 0 || library_.holds(span)) return;
  diagnostics_.add({code, span, std::move(text), std::move(fix), std::move(notes)});
}

void Reporter::allow_extension(const PouScope& scope, std::string_view what, base::SourceSpan span,
                               std::string fix) {
  if (options_.dialect != Dialect::kIec || library_.holds(span)) return;
  error(scope, DiagnosticCode::kExtension, span, std::string(what) + " is no part of the standard",
        std::move(fix));
}

// A conversion that exists: ranges are checked wherever a value gets into one.
std::string Reporter::conversion_fix(ir::TypeId to) const {
  const bool enumeration = is_enum(program_.types, to);
  if (enumeration && options_.dialect == Dialect::kIec) return "choose the literal with CASE";
  const ir::TypeId type = enumeration ? to : without_range(program_.types, to);
  return "convert it explicitly, for example with TO_" + type_text(type);
}

bool Reporter::allow_narrowing(const PouScope& scope, ir::TypeId from, ir::TypeId to,
                               base::SourceSpan span) {
  std::string text =
      "`" + type_text(from) + "` does not fit into `" + type_text(to) + "` without loss";
  const std::string fix = conversion_fix(to);
  if (options_.dialect == Dialect::kIec) {
    error(scope, DiagnosticCode::kTypeMismatch, span, text, fix);
    return false;
  }
  warning(DiagnosticCode::kImplicitNarrowing, span, text, fix);
  return true;
}

}  // namespace frontend
