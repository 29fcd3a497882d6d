// What an instruction list keeps of its current result, or a diagram of a value: a variable
// without a name, whose type comes from the values that reach it from above.
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

bool same_kind_of_string(const ir::TypeTable& types, ir::TypeId a, ir::TypeId b) {
  return is_string(types, a) && types[a].kind == types[b].kind;
}

}  // namespace

Note Expressions::infer_result(const Expr& expr) {
  Note note;
  if (expr.operand.valid()) {
    const Note& first = infer(expr.operand);
    note.type = first.type;
    note.width = first.width;
    return note;
  }
  const ir::TypeTable& types = sema_.program.types;
  Range32 values = sema_.tree.results[expr.number].values;
  Note best;
  for (uint32_t i = 0; i < values.count; ++i) {
    ExprId id = sema_.tree.expr_lists[values.first + i];
    const Note& next = infer(id);
    if (!next.type.valid()) return {};
    if (!best.type.valid()) {
      best = next;
    } else if (same_kind_of_string(types, best.type, next.type)) {
      if (types[next.type].capacity > types[best.type].capacity) best = next;
    } else if (best.flex != Flex::kNone && next.flex == Flex::kNone) {
      best = next;
    } else if (best.flex == Flex::kInteger && next.flex == Flex::kReal) {
      best = next;
    }
  }
  if (!best.type.valid()) return {};
  if (types.is_instance(best.type)) {
    error(DiagnosticCode::kNotAValue, expr.span,
          "an instance of `" + sema_.report.type_text(best.type) + "` is no value",
          "load one of its variables");
    return {};
  }
  note.type = without_range(types, best.type);
  // Kept as a value it is as wide as it was computed; a local at a label has its type.
  if (values.count == 1 && !sema_.tree.results[expr.number].at_label) note.width = best.width;
  if (ExprId target = sema_.tree.results[expr.number].target;
      target.valid() && best.flex != Flex::kNone) {
    ir::TypeId wanted = infer(target).type;
    if (wanted.valid() && !types.is_instance(wanted)) note.type = without_range(types, wanted);
  }
  return note;
}

bool Expressions::check_result(const Stmt& stmt) {
  const ir::TypeTable& types = sema_.program.types;
  const Note& value = infer(stmt.value);
  ir::TypeId wanted = infer(stmt.target).type;
  if (!value.type.valid() || !wanted.valid() || value.flex != Flex::kNone) {
    return true;
  }
  ir::TypeId given = without_range(types, value.type);
  if (given == wanted) return true;
  if (same_kind_of_string(types, given, wanted) &&
      types[given].capacity <= types[wanted].capacity) {
    return true;
  }
  error(DiagnosticCode::kResultsDiffer, stmt.span,
        "the current result is `" + sema_.report.type_text(given) + "` here and `" +
            sema_.report.type_text(wanted) + "` on another way to the same label",
        "convert one of them, or load the operand after the label");
  return false;
}

}  // namespace frontend
