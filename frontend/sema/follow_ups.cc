#include "frontend/sema/follow_ups.h"

namespace frontend {
namespace {

using base::DiagnosticCode;

// Errors inside a literal do no harm to what stands around it.
bool is_syntax(DiagnosticCode code) {
  const base::DiagnosticRow& row = base::diagnostic_row(code);
  bool swallows = code == DiagnosticCode::kUnterminatedString ||
                  code == DiagnosticCode::kUnterminatedComment ||
                  code == DiagnosticCode::kUnterminatedPragma;
  bool syntax = row.severity == base::Severity::kError && row.code[1] == '1';
  return swallows || (syntax && code != DiagnosticCode::kNotSupported);
}

enum class Lookup : uint8_t { kNone, kName, kElsewhere };

// Does the message say that something is not found: a name of this POU, or what is declared
// somewhere else?
Lookup lookup_of(DiagnosticCode code) {
  switch (code) {
    case DiagnosticCode::kUnknownName:
    case DiagnosticCode::kNotAValue:
    case DiagnosticCode::kUnknownAction:
      return Lookup::kName;
    case DiagnosticCode::kUnknownType:
    case DiagnosticCode::kUnknownMember:
    case DiagnosticCode::kNotEnumeration:
    case DiagnosticCode::kUnknownProgram:
      return Lookup::kElsewhere;
    default:
      return Lookup::kNone;
  }
}

// Statements begin here; declarations are in front of it. All of a chart declares something.
base::SourcePos body_of(const Tree& tree, const PouDecl& pou) {
  if (pou.body.count == 0) return pou.span.end;
  return tree[tree.stmt_lists[pou.body.first]].span.begin;
}

}  // namespace

FollowUps::FollowUps(const base::SourceMap& sources, const Tree& tree,
                     const base::Diagnostics& parsed) {
  for (const base::Diagnostic& message : parsed.all()) {
    if (message.code == DiagnosticCode::kUnterminatedComment) globals_ = true;
    if (is_syntax(message.code)) note_damage(sources, tree, message.span.begin);
  }
}

void FollowUps::note_damage(const base::SourceMap& sources, const Tree& tree, base::SourcePos at) {
  for (const PouDecl& pou : tree.pous) {
    if (at < pou.span.begin || !(at < pou.span.end)) continue;
    if (sources.file_of(at) == sources.file_of(pou.span.begin) && at < body_of(tree, pou)) {
      pous_.insert(&pou);
    }
    return;
  }
  globals_ = true;
}

bool FollowUps::silences(DiagnosticCode code, const PouDecl* within, const std::string& text) {
  Lookup lookup = lookup_of(code);
  if (lookup == Lookup::kNone) return false;
  if (globals_ || pous_.contains(within)) return true;
  if (lookup == Lookup::kElsewhere && !pous_.empty()) return true;
  const PouDecl* scope = lookup == Lookup::kName ? within : nullptr;
  return !said_.emplace(scope, text).second;
}

}  // namespace frontend
