// What the parser understands and the later passes do not yet: one message per
// place. Whoever implements a construct takes its line out here.
#include "frontend/sema/declarations/interfaces.h"
#include "frontend/sema/sema.h"

namespace frontend {

void Interfaces::report_not_supported() {
  auto tell = [this](const char* what, base::SourceSpan span) {
    error(DiagnosticCode::kNotSupported, span, std::string(what) + " not supported yet");
  };
  sema_.tree.exprs.each([&](const Expr& expr) {
    if (expr.kind == ExprKind::kType) tell("types as arguments are", expr.span);
  });
}

}  // namespace frontend
