// What code may write, and what others may be led to.
#include <algorithm>

#include "frontend/lower/places.h"
#include "frontend/lower/write_checks.h"
#include "frontend/sema/configuration/common_uses.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {
namespace {

// Is the variable at %I?
bool is_input(const Variable& variable) {
  return variable.decl != nullptr && variable.decl->has_address &&
         variable.decl->address.area == ir::DirectArea::kInput;
}

}  // namespace

// Does it lie where others may be led to? What must not be written does not: an image says of no
// in-out that it is only read.
bool WriteChecks::has_address(ExprId id) {
  const Note& note = infer(id);
  if (note.reference.valid()) return true;
  if (note.property != kNoPou || is_known(note) || note.bit_size != 0 ||
      ask<Places>().is_character(id) || ask<Variables>().holds_input(note.type)) {
    return false;
  }
  if (note.variable.valid()) {
    const Variable* variable = &resolve(note.variable);
    if (variable->external.valid()) variable = &resolve(variable->external);
    if (has_known_value(*variable) || is_input(*variable)) return false;
  }
  const Expr& expr = tree_[id];
  switch (expr.kind) {
    case ExprKind::kName:
    case ExprKind::kDeref:
    case ExprKind::kResult:
      return true;
    case ExprKind::kDirect:
      return tree_.directs[expr.number].address.area != ir::DirectArea::kInput;
    case ExprKind::kMember: {
      if (note.variable.valid()) return true;
      const PouInfo* block = sema_.declared.pou_of(infer(expr.operand).type);
      if (block == nullptr) return !is_input_field(expr) && has_address(expr.operand);
      const VarId variable = ask<Objects>().find_parameter(*block, expr.name.text);
      return variable.valid() && !has_known_value(resolve(variable)) &&
             !is_input(resolve(variable));
    }
    case ExprKind::kIndex:
      return types().is_reference(infer(expr.operand).type) || has_address(expr.operand);
    default:
      return false;
  }
}

bool WriteChecks::check_writable(ExprId id) {
  const Expr& expr = tree_[id];
  if (infer(id).property != kNoPou) {
    if (infer(id).reference.valid()) return true;  // what it leads to
    error(DiagnosticCode::kPropertyAccess, expr.span,
          "`" + std::string(expr.name.text) + "` is a property: its value has no place",
          "assign the property as a whole");
    return false;
  }
  if (sema_.declared.open_array(infer(id).type) != nullptr) {
    error(DiagnosticCode::kNotAssignable, expr.span,
          "an array with open bounds cannot be assigned as a whole", "assign its elements");
    return false;
  }
  switch (expr.kind) {
    case ExprKind::kName:
      return check_writable_name(expr);
    case ExprKind::kDirect: {
      const ir::DirectAddress address = tree_.directs[expr.number].address;
      ask<Places>().note_output(address, infer(id).type, expr.span);
      if (address.area != ir::DirectArea::kInput || info_.test) return true;
      error(DiagnosticCode::kAssignToInput, expr.span,
            "`" + std::string(expr.name.text) + "` is an input of the process image");
      return false;
    }
    case ExprKind::kMember: {
      if (ask<Objects>().refuse_change(id)) return false;
      if (VarId global = infer(id).variable; global.valid()) {
        return check_writable_variable(expr, global);
      }
      const PouInfo* block = sema_.declared.pou_of(infer(expr.operand).type);
      if (block == nullptr) return check_writable_field(expr) && check_writable(expr.operand);
      const Variable& variable = resolve(ask<Objects>().find_parameter(*block, expr.name.text));
      if (variable.section == VarSection::kInput) return true;
      if (variable.section != VarSection::kOutput || info_.test)
        return check_writable_variable(expr, ask<Objects>().find_parameter(*block, expr.name.text));
      error(DiagnosticCode::kNotAssignable, expr.span,
            "`" + std::string(expr.name.text) + "` is an output of `" +
                std::string(block->decl->name.text) + "`; only the block itself writes it");
      return false;
    }
    case ExprKind::kDeref:
    case ExprKind::kResult:
      return true;
    case ExprKind::kIndex: {
      const ir::TypeId whole = infer(expr.operand).type;
      if (types().is_reference(whole) || sema_.declared.open_array(whole) != nullptr) return true;
      return check_writable(expr.operand);
    }
    case ExprKind::kBit:
      return check_writable(expr.operand);
    default:
      if (infer(id).reference.valid()) return true;  // what a method returns
      error(DiagnosticCode::kNotAssignable, expr.span, "this is a value, not a variable");
      return false;
  }
}

// A member of a structure that stands at %I.
bool WriteChecks::is_input_field(const Expr& expr) {
  ir::TypeId structure = infer(expr.operand).type;
  int32_t member = sema_.declared.find_member(structure, expr.name.text);
  if (member < 0) return false;
  const ir::Member& field = types()[structure].members[static_cast<size_t>(member)];
  return field.address.area == ir::DirectArea::kInput;
}

bool WriteChecks::check_writable_field(const Expr& expr) {
  if (!is_input_field(expr) || info_.test) return true;
  error(DiagnosticCode::kAssignToInput, expr.span,
        "`" + std::string(expr.name.text) + "` is an input", "copy it to a variable of its own");
  return false;
}

bool WriteChecks::check_writable_name(const Expr& expr) {
  VarId id = ask<Variables>().find_variable(expr);
  if (id.valid()) return check_writable_variable(expr, id);
  error(DiagnosticCode::kNotAssignable, expr.span,
        "`" + std::string(expr.name.text) + "` is not a variable");
  return false;
}

bool WriteChecks::check_writable_variable(const Expr& expr, VarId id) {
  const auto name = [&expr] { return "`" + std::string(expr.name.text) + "`"; };
  const Variable* variable = &resolve(id);
  bool constant = variable->constant;
  if (variable->external.valid()) {
    id = variable->external;
    variable = &resolve(id);
  }
  if (variable->decl != nullptr && variable->decl->implied) {
    error(DiagnosticCode::kNotAssignable, expr.span,
          name() + " belongs to the chart, which alone changes it",
          "steps change by transitions, actions by the steps that use them");
    return false;
  }
  if (constant || variable->constant) {
    error(DiagnosticCode::kAssignToConstant, expr.span, name() + " is a constant");
    return false;
  }
  bool own_input =
      variable->section == VarSection::kInput && sema_.options.dialect == Dialect::kIec;
  if ((is_input(*variable) || own_input) && !info_.test) {
    error(DiagnosticCode::kAssignToInput, expr.span, name() + " is an input",
          "copy it to a variable of its own");
    return false;
  }
  sema_.mark_written(id);
  ask<Places>().note_outer_use(id, true, expr.span);
  if (variable->decl != nullptr && variable->decl->has_address && !variable->decl->incomplete) {
    ask<Places>().note_output(variable->decl->address, variable->type, expr.span);
  }
  if (std::find(body_.flow.for_variables.begin(), body_.flow.for_variables.end(), id) !=
      body_.flow.for_variables.end()) {
    warning(DiagnosticCode::kForVariableAssigned, expr.span,
            name() + " counts the surrounding FOR loop");
  }
  return true;
}

}  // namespace frontend
