// Constant calls: `N : INT := MAX(A, 3)` is lowered to a function of its own, which the
// evaluator runs. So there is one definition of what each standard function does.
#include "frontend/lower/body.h"
#include "frontend/sema/width.h"
#include "ir/program/evaluate.h"

namespace frontend {
namespace {

constexpr uint64_t kBudget = 100'000;

}  // namespace

std::optional<Constant> Body::evaluate(Sema& sema, const PouScope& scope, ExprId id,
                                       ir::TypeId context) {
  PouInfo info;
  Body body(sema, scope, info, kNoPou, ir::Pou{});
  body.evaluating_ = true;
  base::SourceSpan span = sema.tree[id].span;
  body.lines_.leave_out(span.begin);
  Note note = body.infer(id);
  const bool wide = note.width == Width::kWide;
  ir::TypeId type = without_range(sema.program.types,
                                  wide ? computed_type(sema, note) : body.own_type(note, context));
  if (sema.program.types.is_scalar(type)) {
    ir::ValueId value = body.emit(id, type);
    ir::Place result = body.temporary_place(type);
    body.build_.store(result, body.scalar(type), value);
    return body.run_alone(result.base_index, span);
  }
  if (!is_string(sema.program.types, type)) {
    body.error(DiagnosticCode::kNotConstant, span, "this has to be known when compiling");
    return std::nullopt;
  }
  ir::Place from = body.call_place(id, sema.tree[id]);
  ir::Place result = body.temporary_place(type);
  body.build_.copy(result, from);
  return body.run_alone(result.base_index, span);
}

std::optional<Constant> Body::run_alone(uint32_t local, base::SourceSpan span) {
  build_.finish();
  ir::TypeId type = out_.locals[local].type;
  ir::EvalResult result = ir::evaluate_alone(sema_.program, out_, local, kBudget);
  if (result.trap) {
    error(DiagnosticCode::kConstantTraps, span,
          "this cannot be computed: " + std::string(ir::trap_name(result.trap->kind)) +
              (result.trap->text.empty() ? "" : " (" + result.trap->text + ")"));
    return std::nullopt;
  }
  if (types().is_scalar(type)) return scalar_constant(types(), type, result.bits);
  Constant value;
  value.form = Constant::Form::kText;
  value.type = type;
  value.text = std::move(result.text);
  return value;
}

std::optional<Constant> evaluate_constant(Sema& sema, const PouScope& scope, ExprId expr,
                                          ir::TypeId context) {
  return Body::evaluate(sema, scope, expr, context);
}

}  // namespace frontend
