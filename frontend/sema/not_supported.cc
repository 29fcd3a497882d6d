// What the parser understands and the later passes do not yet: one message per
// place. Whoever implements a construct takes its line out here.
#include "frontend/sema/query_interface.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

const char* spec_feature(const Spec& spec) {
  switch (spec.kind) {
    case SpecKind::kNamed:
      return spec.qualifiers.count != 0 ? "types of a namespace or library are" : nullptr;
    default:
      return nullptr;
  }
}

const char* expression_feature(const Expr& expr) {
  switch (expr.kind) {
    case ExprKind::kQualified:
      return expr.operand.valid() ? "types of a namespace or library are" : nullptr;
    case ExprKind::kType:
      return "types as arguments are";
    default:
      return nullptr;
  }
}

}  // namespace

void Sema::report_not_supported() {
  auto report = [this](const char* what, base::SourceSpan span) {
    if (what == nullptr) return;
    error(DiagnosticCode::kNotSupported, span, std::string(what) + " not supported yet");
  };
  for (const Spec& spec : tree.specs) {
    if (!is_query_interface(tree, spec)) report(spec_feature(spec), spec.span);
  }
  for (const Expr& expr : tree.exprs) report(expression_feature(expr), expr.span);
  for (const Scope& scope : tree.scopes) {
    if (!scope.name.empty()) report("namespaces are", scope.name.span);
    for (Range32 path : scope.usings) report("USING is", tree.names[path.first].span);
  }
}

}  // namespace frontend
