// Store: what is known of expressions and type expressions. Those of a POU that has instances of
// its own (open functions, programs with connections) mean something else in each of them, so the
// store is asked with the scope.
#pragma once

#include <vector>

#include "frontend/sema/model.h"
#include "frontend/sema/note_store.h"

namespace frontend {

class Facts {
 public:
  explicit Facts(const Tree& tree) : specs(tree.specs.size()), tree_(tree) {
    notes.grow(tree.exprs.end());
  }

  Note& of(const PouScope& scope, ExprId expr) {
    return scope.meaning != nullptr ? scope.meaning->notes[expr.index] : notes[expr.index];
  }
  SpecInfo& of(const PouScope& scope, SpecId spec) {
    if (scope.meaning == nullptr) return specs[spec.index];
    const base::SourceSpan own = scope.pou->decl->span;
    const base::SourcePos at = tree_[spec].span.begin;
    const bool inside = !(at < own.begin) && at < own.end;
    return inside ? scope.meaning->specs[spec.index] : specs[spec.index];
  }

  // Of declarations that mean the same everywhere.
  NoteStore notes;
  std::vector<SpecInfo> specs;

  uint32_t depth = 0;  // of what is being resolved

 private:
  const Tree& tree_;
};

}  // namespace frontend
