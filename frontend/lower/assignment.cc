// Assignments, also as expressions: `a := b := 3`, `x S= y`. The indices of the left side
// are evaluated first, then the value.
#include "frontend/lower/assignments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/current_results.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/references.h"
#include "frontend/lower/targets.h"
#include "frontend/sema/constants/constants.h"
#include "ir/types/parts.h"

namespace frontend {

void Assignments::assign(const Stmt& stmt) {
  if (stmt.assign == AssignOp::kReference) return ask<References>().bind_reference(stmt);
  if (stmt.assign == AssignOp::kAttempt) {
    ask<References>().attempt(stmt.target, stmt.value, stmt.span);
    return;
  }
  if (stmt.assign == AssignOp::kSet || stmt.assign == AssignOp::kReset) {
    if (!stmt.instruction) {
      allow_set_or_reset(stmt.span);
    } else if (ir::TypeId type = infer(stmt.target).type;
               stmt.from.valid() && type.valid() && types().is_instance(type)) {
      Stmt call = stmt;
      call.value = stmt.from;
      return ask<CallCode>().call_statement(call);
    }
    set_or_reset(stmt.assign, stmt.target, stmt.value, stmt.span);
  } else if (stmt.assign == AssignOp::kAssign) {
    if (tree_[stmt.target].kind == ExprKind::kResult)
      return ask<CurrentResults>().keep_result(stmt);
    assign_value(stmt.target, stmt.value, stmt.span);
  }
}

std::optional<Target> Assignments::assign_value(ExprId left, ExprId right, base::SourceSpan span) {
  const Expr& source = tree_[right];
  bool list = source.kind == ExprKind::kArrayInit || source.kind == ExprKind::kStructInit;
  auto to = target(left);
  if (!to) {
    if (!list) infer(right);  // its errors count too
    return std::nullopt;
  }
  if (!types().is_scalar(to->type)) {
    assign_aggregate(*to, right);
    ask<MethodCode>().settle(*to);
    return to;
  }
  ir::ValueId from = value(right, to->type);
  if (traits_of(types(), to->type).boolean) body_.counting.power(from, left, span.begin);
  set_line(span);
  store(*to, from);
  return to;
}

void Assignments::allow_set_or_reset(base::SourceSpan span) {
  allow_extension("an assignment with S= or R=", span, "write IF condition THEN x := TRUE; END_IF");
}

// The value of `x S= y` is y: in `a S= b R= y` both follow the same y.
ir::ValueId Assignments::set_or_reset(AssignOp op, ExprId left, ExprId right,
                                      base::SourceSpan span) {
  ir::TypeId boolean = elementary(ir::Kind::kBool);
  auto to = target(left);
  ir::ValueId condition = value(right, boolean);
  if (!to) return condition;
  if (!traits_of(types(), to->type).boolean) {
    error(DiagnosticCode::kTypeMismatch, tree_[left].span,
          "a `" + sema_.report.type_text(to->type) + "` cannot be " +
              (op == AssignOp::kSet ? "set" : "reset"),
          "only BOOL variables can be");
    return condition;
  }
  body_.counting.power(condition, left, span.begin);
  set_line(span);
  ir::BlockId change = build_.new_block();
  ir::BlockId done = build_.new_block();
  build_.branch(condition, change, done);
  build_.start(change);
  store(*to, build_.constant(ir::Scalar::kBool, op == AssignOp::kSet ? 1 : 0));
  build_.jump(done);
  build_.start(done);
  return condition;
}

// The value of an assignment is what its variable holds then.
ir::ValueId Assignments::emit_assignment(const Expr& expr) {
  if (expr.assign == AssignOp::kSet || expr.assign == AssignOp::kReset) {
    allow_set_or_reset(expr.span);
    return set_or_reset(expr.assign, expr.operand, expr.right, expr.span);
  }
  if (expr.assign == AssignOp::kAttempt) {
    return ask<References>().attempt(expr.operand, expr.right, expr.span).handle;
  }
  auto to = assign_value(expr.operand, expr.right, expr.span);
  return to ? ask<Targets>().load(*to) : code_.zero(infer(expr.operand).type);
}

ir::Place Assignments::assignment_place(ExprId id, const Expr& expr) {
  auto to = assign_value(expr.operand, expr.right, expr.span);
  return to ? to->place : temporary_place(infer(id).type);
}

// {attribute 'no_assign'} in front of a block.
bool Assignments::refuse_copy(ir::TypeId type, base::SourceSpan span) {
  while (types()[type].kind == ir::Kind::kArray) type = types()[type].base;
  const PouInfo* block = types().is_instance(type) ? sema_.declared.pou_of(type) : nullptr;
  if (block == nullptr || tree_.find_attribute(block->decl->attributes, "no_assign") == nullptr) {
    return false;
  }
  error(DiagnosticCode::kNotAssignable, span,
        "instances of `" + sema_.report.type_text(type) + "` cannot be assigned: 'no_assign'",
        "pass a REFERENCE TO it, or copy the variables that matter");
  return true;
}

void Assignments::assign_aggregate(const Target& to, ExprId value) {
  const Expr& expr = tree_[value];
  const bool held = ir::holds_instance(sema_.program.types, to.type);
  const bool list = expr.kind == ExprKind::kArrayInit || expr.kind == ExprKind::kStructInit;
  if (held && (list || sema_.options.dialect == Dialect::kIec)) {
    error(DiagnosticCode::kNotAssignable, expr.span,
          "instances of `" + sema_.report.type_text(to.type) + "` cannot be assigned",
          "copy the variables that matter one by one");
    return;
  }
  if (held && refuse_copy(to.type, expr.span)) return;
  if (list) {
    ir::ConstId init = ask<Constants>().initial_value(value, to.type, {}, Known::kByCall);
    if (init.valid()) build_.init(to.place, init);
    return;
  }
  const Note& note = infer(value);
  if (!note.type.valid()) return;
  bool strings = is_string(types(), to.type) && types()[note.type].kind == types()[to.type].kind;
  if (!strings && note.type != to.type) {
    error(DiagnosticCode::kTypeMismatch, expr.span,
          "`" + sema_.report.type_text(note.type) + "` does not go with `" +
              sema_.report.type_text(to.type) + "`");
    return;
  }
  if (strings && note.constant) {  // says so when the text is too long
    auto text = ask<Constants>().fold(value, to.type);
    if (!text || !ask<Constants>().fit_text(*text, to.type, expr.span)) return;
  }
  ir::Place from = place(value);
  if (!held) return build_.copy(to.place, from);
  set_line(expr.span);
  copy_held(to.place, from, to.type);
}

}  // namespace frontend
