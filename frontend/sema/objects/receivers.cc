// Finds out whose member is meant: THIS, SUPER, instances, references, interface variables.
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {}  // namespace

bool Objects::is_own(const Expr& expr) const {
  const Expr& head = expr.kind == ExprKind::kDeref ? sema_.tree[expr.operand] : expr;
  return head.kind == ExprKind::kThis || head.kind == ExprKind::kSuper;
}

bool Objects::is_super(const Expr& expr) const {
  const Expr& head = expr.kind == ExprKind::kDeref ? sema_.tree[expr.operand] : expr;
  return head.kind == ExprKind::kSuper;
}

uint32_t Objects::receiver(ExprId operand) {
  const Expr& expr = sema_.tree[operand];
  if (is_super(expr)) return super(expr.span);
  const Note& note = infer(operand);
  if (!note.type.valid()) return kNoPou;
  const bool leads = expr.kind == ExprKind::kThis || is_interface(sema_.program.types, note.type);
  const ir::TypeId type = leads ? sema_.program.types[note.type].base : note.type;
  const PouInfo* pou = sema_.declared.pou_of(type);
  return pou == nullptr ? kNoPou : pou->number;
}

// The base of the own block; reports.
uint32_t Objects::super(base::SourceSpan span) {
  const uint32_t own = sema_.declared.block_of(scope_);
  const uint32_t base = own == kNoPou ? kNoPou : sema_.declared.pous[own].base;
  if (base == kNoPou && (own == kNoPou || sema_.declared.pous[own].decl->extends.empty())) {
    error(DiagnosticCode::kBadThis, span,
          own == kNoPou ? std::string("SUPER stands outside of a function block")
                        : quoted(sema_.declared.pous[own].decl->name) + " has no base",
          "SUPER is for blocks that are declared with EXTENDS");
  }
  return base;
}

Note Objects::infer_this(const Expr& expr) {
  const uint32_t own = sema_.declared.block_of(scope_);
  Note note;
  if (expr.kind == ExprKind::kSuper) {
    if (super(expr.span) == kNoPou) return {};
    error(DiagnosticCode::kBadThis, expr.span, "SUPER is no value",
          "write SUPER^.member or SUPER^(); THIS refers to the instance");
    return {};
  }
  if (own == kNoPou) {
    error(DiagnosticCode::kBadThis, expr.span, "THIS stands outside of a function block",
          "only code of function blocks, classes and programs has an instance");
    return {};
  }
  note.type = sema_.program.types.pointer(sema_.declared.pous[own].self);
  return note;
}

bool Objects::check_access(Access access, uint32_t owner, const Name& name) {
  const uint32_t own = sema_.declared.block_of(scope_);
  if (in_test() && access != Access::kInternal) return true;
  const char* word = nullptr;
  if (access == Access::kPrivate && own != owner) word = "PRIVATE";
  if (access == Access::kProtected && !(own != kNoPou && extends(own, owner))) word = "PROTECTED";
  if (access == Access::kInternal &&
      !sema_.namespaces.inside(name.span.begin, sema_.declared.pous[owner].decl->scope)) {
    word = "INTERNAL";
  }
  if (word == nullptr) return true;
  error(DiagnosticCode::kNotAccessible, name.span,
        quoted(name) + " is " + word + " in " + quoted(sema_.declared.pous[owner].decl->name),
        access == Access::kPrivate     ? "only that block itself uses it"
        : access == Access::kProtected ? "only blocks that extend that one use it"
                                       : "only code of the same namespace uses it");
  return false;
}

// A method without a specifier is PUBLIC, but PROTECTED in the standard (edition 3, 6.6.5).
bool Objects::check_access(const PouInfo& method, const Name& name) {
  Access access = method.decl->access;
  const PouInfo& owner = sema_.declared.pous[method.owner];
  const bool closed = sema_.options.dialect == Dialect::kIec &&
                      owner.decl->kind != PouKind::kInterface &&
                      method.decl->kind != PouKind::kAction;
  if (access == Access::kDefault && closed) access = Access::kProtected;
  return check_access(access, method.owner, name);
}

}  // namespace frontend
