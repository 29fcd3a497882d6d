// Inputs of type ANY, ANY_NUM and the like as CODESYS and TwinCAT have them: a record of the
// variable that is given (stdlib/st/any.st). Inputs of methods and function blocks are such
// records, and those of a function whose body names a part of one. Other functions have code for
// each type that they are called with, as the standard says (calls/open_functions.h).
#include <algorithm>

#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/sema.h"

namespace frontend {

bool Collection::is_any_part(std::string_view name) {
  return ir::same_name(name, "pvalue") || ir::same_name(name, "diSize") ||
         ir::same_name(name, "TypeClass");
}

bool Collection::takes_any(const VarDecl& decl, VarSection section, const PouDecl& pou) const {
  if (section != VarSection::kInput || sema_.options.dialect == Dialect::kIec) return false;
  if (!decl.spec.valid()) return false;
  const Spec& spec = sema_.tree[decl.spec];
  if (spec.kind != SpecKind::kNamed || !is_generic_name(spec.name.text)) return false;
  const bool block = pou.kind == PouKind::kFunctionBlock || pou.kind == PouKind::kMethod;
  if (block) return !sema_.library.holds(pou.span);
  return pou.kind == PouKind::kFunction && names_any_part(decl, pou);
}

// The expressions of all bodies are there while declarations are collected for the first time.
bool Collection::names_any_part(const VarDecl& decl, const PouDecl& pou) const {
  Declarations& known = sema_.declared;
  if (!known.any_parts_known) {
    known.any_parts_known = true;
    sema_.tree.exprs.each([&](const Expr& expr) {
      if (expr.kind != ExprKind::kMember || !is_any_part(expr.name.text)) return;
      const Expr& whole = sema_.tree[expr.operand];
      if (whole.kind == ExprKind::kName) known.any_parts.push_back(whole.name);
    });
    std::ranges::sort(known.any_parts,
                      [](const Name& a, const Name& b) { return a.span.begin < b.span.begin; });
  }
  auto used = std::ranges::partition_point(
      known.any_parts, [&](const Name& one) { return one.span.begin < pou.span.begin; });
  for (; used != known.any_parts.end() && used->span.begin < pou.span.end; ++used) {
    for (const Name& name : decl.names) {
      if (ir::same_name(name.text, used->text)) return true;
    }
  }
  return false;
}

}  // namespace frontend
