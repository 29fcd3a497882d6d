// Constant calls: `N : INT := MAX(A, 3)` is lowered to a function of its own, which the
// evaluator runs. So there is one definition of what each standard function does.
#include "frontend/lower/call_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/expressions/width.h"
#include "ir/program/evaluate.h"

namespace frontend {
namespace {

constexpr uint64_t kBudget = 100'000;

// One expression that is known, as a function of its own.
class Evaluation : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;
  // Its value, by running its code here and now.
  std::optional<Constant> evaluate(ExprId id, ir::TypeId context);

 private:
  std::optional<Constant> run_alone(uint32_t local, base::SourceSpan span);
};

std::optional<Constant> Evaluation::evaluate(ExprId id, ir::TypeId context) {
  const base::SourceSpan span = tree_[id].span;
  body_.lines.leave_out(span.begin);
  Note note = infer(id);
  const bool wide = note.width == Width::kWide;
  ir::TypeId type = without_range(
      types(), wide ? computed_type(sema_, note) : ask<Values>().own_type(id, context));
  if (types().is_scalar(type)) {
    ir::ValueId value = ask<Values>().emit(id, type);
    ir::Place result = temporary_place(type);
    build_.store(result, scalar(type), value);
    return run_alone(result.base_index, span);
  }
  if (!is_string(types(), type)) {
    error(DiagnosticCode::kNotConstant, span, "this has to be known when compiling");
    return std::nullopt;
  }
  ir::Place from = ask<CallCode>().call_place(id, tree_[id]);
  ir::Place result = temporary_place(type);
  build_.copy(result, from);
  return run_alone(result.base_index, span);
}

std::optional<Constant> Evaluation::run_alone(uint32_t local, base::SourceSpan span) {
  build_.finish();
  ir::TypeId type = body_.out.locals[local].type;
  ir::EvalResult result = ir::evaluate_alone(sema_.program, body_.out, local, kBudget);
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

}  // namespace

std::optional<Constant> evaluate_constant(Sema& sema, const PouScope& scope, ExprId expr,
                                          ir::TypeId context) {
  PouInfo info;
  Lowering body(sema, info, kNoPou, ir::Pou{});
  body.evaluating = true;
  return Evaluation(body, scope).evaluate(expr, context);
}

}  // namespace frontend
