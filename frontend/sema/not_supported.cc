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

const char* assign_feature(AssignOp op) {
  switch (op) {
    case AssignOp::kAssign:
    case AssignOp::kReference:
      return nullptr;
    case AssignOp::kSet:
    case AssignOp::kReset:
      return nullptr;
    case AssignOp::kAttempt:
      return nullptr;
  }
  return nullptr;
}

const char* expression_feature(const Expr& expr) {
  switch (expr.kind) {
    case ExprKind::kQualified:
      return expr.operand.valid() ? "types of a namespace or library are" : nullptr;
    case ExprKind::kDirect:
      return expr.levels.count != 0 ? "hierarchical addresses are" : nullptr;
    case ExprKind::kType:
      return "types as arguments are";
    case ExprKind::kAssign:
      return assign_feature(expr.assign);
    default:
      return nullptr;
  }
}

const char* statement_feature(const Stmt& stmt) {
  switch (stmt.kind) {
    case StmtKind::kAssign:
      return assign_feature(stmt.assign);
    default:
      return nullptr;
  }
}

const char* variable_feature(const VarDecl& decl, bool field) {
  if (decl.levels.count != 0) return "hierarchical addresses are";
  return field && decl.has_address && decl.address.area != ir::DirectArea::kNone
             ? "members with an address are"
             : nullptr;
}

}  // namespace

void Sema::report_not_supported() {
  auto report = [this](const char* what, base::SourceSpan span) {
    if (what == nullptr) return;
    error(DiagnosticCode::kNotSupported, span, std::string(what) + " not supported yet");
  };
  auto blocks = [&](const std::vector<VarBlock>& list) {
    for (const VarBlock& block : list) {
      for (const VarDecl& decl : block.vars) report(variable_feature(decl, false), decl.span);
    }
  };
  for (const Spec& spec : tree.specs) {
    if (!is_query_interface(tree, spec)) report(spec_feature(spec), spec.span);
    for (const VarDecl& field : spec.fields) report(variable_feature(field, true), field.span);
  }
  for (const Expr& expr : tree.exprs) report(expression_feature(expr), expr.span);
  for (const Stmt& stmt : tree.stmts) report(statement_feature(stmt), stmt.span);
  for (const Scope& scope : tree.scopes) {
    if (!scope.name.empty()) report("namespaces are", scope.name.span);
    for (Range32 path : scope.usings) report("USING is", tree.names[path.first].span);
  }
  for (const PouDecl& pou : tree.pous) {
    blocks(pou.blocks);
    for (const PouDecl& member : pou.members) blocks(member.blocks);
  }
  blocks(tree.globals);
  for (const ConfigDecl& config : tree.configs) {
    blocks(config.globals);
    for (const ResourceDecl& resource : config.resources) {
      blocks(resource.globals);
      for (const ProgramDecl& decl : resource.programs) {
        if (decl.retain) report("RETAIN for a whole program is", decl.span);
      }
    }
  }
}

}  // namespace frontend
