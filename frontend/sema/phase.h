// What the phases of sema have in common: the stores, and the scope that they look from, which is
// a value. A phase has no state of its own: who needs one makes it, `ask<Types>().find_type(name)`.
// What is asked for is resolved on the spot, so the phases ask each other in circles.
#pragma once

#include <string>
#include <utility>

#include "frontend/sema/callee.h"
#include "frontend/sema/sema.h"

namespace frontend {

class Phase {
 public:
  explicit Phase(Sema& sema, const PouScope& scope = {}) : sema_(sema), scope_(scope) {}

  // The type of an expression, and what else is known of it, before its context has spoken.
  const Note& infer(ExprId expr) const {
    Note& known = sema_.facts.of(scope_, expr);
    return known.progress == Progress::kDone ? known : infer_anew(expr, known);
  }
  // A variable with its type and its initial value.
  const Variable& resolve(VarId id) const {
    const Variable& variable = sema_.declared.variables[id.index];
    return variable.progress == Progress::kDone ? variable : resolve_anew(id);
  }

  void error(DiagnosticCode code, base::SourceSpan span, std::string text, Fix fix = {}) const {
    sema_.report.error(scope_, code, span, std::move(text), std::move(fix));
  }
  void warning(DiagnosticCode code, base::SourceSpan span, std::string text,
               std::string fix = {}) const {
    sema_.report.warning(code, span, std::move(text), std::move(fix));
  }
  bool allow_narrowing(ir::TypeId from, ir::TypeId to, base::SourceSpan span) const {
    return sema_.report.allow_narrowing(scope_, from, to, span);
  }
  void allow_extension(std::string_view what, base::SourceSpan span, std::string fix = {}) const {
    sema_.report.allow_extension(scope_, what, span, std::move(fix));
  }

  // Is it code of a test, which may use what is private?
  bool in_test() const { return scope_.pou != nullptr && scope_.pou->test; }

  // Another phase, for the same scope.
  template <class Other>
  Other ask() const {
    return Other(sema_, scope_);
  }
  Sema& sema() const { return sema_; }

 protected:
  Sema& sema_;
  PouScope scope_;

 private:
  const Note& infer_anew(ExprId expr, Note& known) const;
  const Variable& resolve_anew(VarId id) const;
};

}  // namespace frontend
