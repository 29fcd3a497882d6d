// What a variable, member or element starts with: the meaning of `y : INT := x.a[2]`.
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/sema.h"

namespace frontend {

// What `list` says about a member or element; the last mention counts.
ir::ConstId Constants::listed(ir::ConstId list, uint64_t index) const {
  ir::ConstId found;
  if (!list.valid()) return found;
  for (const ir::ConstElement& element : sema_.program.constants[list].elements) {
    if (index >= element.first && index - element.first < element.count) found = element.value;
  }
  return found;
}

// Works for an instance whose block is not resolved yet, too.
ir::ConstId Constants::member_default(ir::TypeId type, uint32_t member) {
  if (const PouInfo* block = sema_.declared.pou_of(type)) {
    const VarId id = ask<Objects>().member_variable(*block, member);
    return id.valid() ? resolve(id).init : ir::ConstId();
  }
  if (ir::ConstId own = listed(sema_.program.types[type].init, member); own.valid()) return own;
  return sema_.program.types[type].members[member].init;
}

std::optional<TypeUse> Constants::initial_part(ExprId id) {
  const Expr& expr = sema_.tree[id];
  const Note& note = infer(id);
  if (!note.type.valid()) return std::nullopt;
  if (note.variable.valid()) return initial_variable(expr, note.variable);
  switch (expr.kind) {
    case ExprKind::kMember:
      return initial_member(expr);
    case ExprKind::kIndex:
      return initial_element(expr);
    default:
      error(DiagnosticCode::kNotConstant, expr.span, "this has no initial value",
            "name a variable, one of its members or elements");
      return std::nullopt;
  }
}

std::optional<TypeUse> Constants::initial_variable(const Expr& expr, VarId id) {
  const Variable& variable = resolve(id);
  if (variable.progress == Progress::kBusy) {  // resolve() has reported constants
    if (variable.constant) return std::nullopt;
    error(DiagnosticCode::kRecursiveConstant, expr.span,
          "the initial value of `" + std::string(expr.name.text) + "` depends on itself");
    return std::nullopt;
  }
  if (!variable.type.valid()) return std::nullopt;
  return TypeUse{variable.type, variable.init};
}

std::optional<TypeUse> Constants::initial_member(const Expr& expr) {
  auto whole = initial_part(expr.operand);
  if (!whole) return std::nullopt;
  int32_t member = sema_.declared.find_member(whole->type, expr.name.text);
  ir::TypeId type;
  if (const PouInfo* block = sema_.declared.pou_of(whole->type)) {
    const Variable& variable = resolve(ask<Objects>().find_parameter(*block, expr.name.text));
    member = static_cast<int32_t>(variable.index);
    type = variable.type;
  } else {
    type = sema_.program.types[whole->type].members[static_cast<uint32_t>(member)].type;
  }
  uint32_t index = static_cast<uint32_t>(member);
  ir::ConstId init = listed(whole->init, index);
  return TypeUse{type, init.valid() ? init : member_default(whole->type, index)};
}

std::optional<TypeUse> Constants::initial_element(const Expr& expr) {
  auto whole = initial_part(expr.operand);
  if (!whole) return std::nullopt;
  std::vector<ir::Dimension> dims = sema_.program.types[whole->type].dims;
  uint64_t flat = 0;
  for (uint32_t i = 0; i < expr.list.count && i < dims.size(); ++i) {
    ExprId at = sema_.tree.expr_lists[expr.list.first + i];
    auto value = fold(at, {}, Known::kInitially);
    if (!value) return std::nullopt;
    if (value->integer < dims[i].low || value->integer > dims[i].high) {
      error(DiagnosticCode::kIndexOutOfBounds, sema_.tree[at].span,
            "index " + wide_text(value->integer) + " is outside " + std::to_string(dims[i].low) +
                ".." + std::to_string(dims[i].high));
      return std::nullopt;
    }
    flat = flat * dims[i].count() + static_cast<uint64_t>(value->integer - dims[i].low);
  }
  return TypeUse{sema_.program.types[whole->type].base, listed(whole->init, flat)};
}

}  // namespace frontend
