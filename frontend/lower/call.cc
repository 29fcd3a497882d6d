// Calls of functions and function block instances, by the call discipline of
// ir/program/ir.h: everything is evaluated first, then passed, then called.
#include "frontend/lower/arguments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/conversions.h"
#include "frontend/lower/enable.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/standard_code.h"
#include "frontend/lower/test_code.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/declarations/unused.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {
namespace {

ir::Step member_step(uint32_t index) {
  ir::Step step;
  step.kind = ir::StepKind::kMember;
  step.index = index;
  return step;
}

}  // namespace

void CallCode::call_instance(const Expr& call, uint32_t pou) {
  const PouInfo& block = sema_.declared.pous[pou];
  info_.callees.push_back(pou);
  std::vector<Binding> bindings;
  bool good = ask<Arguments>().bind_arguments(call, block, bindings) &&
              ask<Arguments>().check_in_outs(call, block, bindings);
  if (!good) return;
  ir::Place instance = place(call.operand);
  auto place_of = [&](const Variable& variable) {
    ir::Place out = instance;
    out.steps.push_back({});
    out.steps.back().kind = ir::StepKind::kEnter;
    out.steps.push_back(member_step(variable.index));
    out.type = variable.type;
    return out;
  };
  ask<Arguments>().evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput)
      ask<Arguments>().pass_input(binding, place_of(variable));
  }
  ask<Arguments>().pass_initial_inputs(block, bindings, place_of);
  build_.call_instance(instance);
  ask<Arguments>().take_outputs(bindings, place_of);
}

// SUPER^(): parameters are members of the own instance.
void CallCode::call_base(const Expr& call, uint32_t pou) {
  const PouInfo& base = sema_.declared.pous[pou];
  info_.callees.push_back(pou);
  std::vector<Binding> bindings;
  if (!ask<Arguments>().bind_arguments(call, base, bindings)) return;
  auto place_of = [&](const Variable& variable) { return member_variable_place(variable); };
  ask<Arguments>().evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput)
      ask<Arguments>().pass_input(binding, place_of(variable));
  }
  ask<Arguments>().pass_initial_inputs(base, bindings, place_of);
  build_.call_body(base.id);
  ask<Arguments>().take_outputs(bindings, place_of);
}

CallResult CallCode::call_function(const Expr& call, const Callee& callee, bool wants_result) {
  const PouInfo& function = sema_.declared.pous[callee.pou];
  const bool method = callee.kind == Callee::Kind::kMethod;
  if (!method) info_.callees.push_back(callee.pou);
  std::vector<Binding> bindings;
  CallResult result;
  bool good = ask<Arguments>().bind_arguments(call, function, bindings) &&
              ask<Arguments>().check_in_outs(call, function, bindings) &&
              ask<Arguments>().check_given(call, function, bindings);
  if (!good) return result;
  warn_about_use(call, function);
  Receiver receiver;
  if (method) {
    receiver = ask<MethodCode>().receiver_of(tree_[call.operand]);
    ask<MethodCode>().prepare_receiver(function, receiver);
  }
  ask<Arguments>().evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput) {
      ask<Arguments>().pass_input(binding, ask<Arguments>().argument_place(function, variable));
    }
  }
  ask<Arguments>().pass_defaults(function, bindings);
  if (method) {
    ask<MethodCode>().emit_method_call(function, receiver);
  } else {
    build_.call_function(function.id);
  }
  if (wants_result && function.result.valid()) result = ask<MethodCode>().result_of(function);
  ask<Arguments>().take_outputs(bindings, [&](const Variable& variable) {
    return ask<Arguments>().argument_place(function, variable);
  });
  return result;
}

void CallCode::warn_about_use(const Expr& call, const PouInfo& callee) {
  report_obsolete(*this, callee, call.span);
  if (callee.owner == kNoPou || tree_[call.operand].kind != ExprKind::kMember) return;
  const std::string_view name = callee.decl->name.text;
  const bool construction = ir::same_name(name, kFbInit) || ir::same_name(name, kFbExit);
  const bool own = ir::same_name(name, info_.decl->name.text);
  if (!construction || !own || !ask<Objects>().runs_bases(name)) return;
  if (!ask<Objects>().is_super(tree_[tree_[call.operand].operand])) return;
  const bool init = ir::same_name(name, kFbInit);
  warning(DiagnosticCode::kBaseRunsTwice, call.span,
          std::string(name) + " of the base runs once more: " +
              (init ? "it has run before this one" : "it runs after this one"),
          "remove the call");
}

// Warns when the result of a function that only computes is not used.
void CallCode::check_result_use(const Expr& call) {
  for (uint32_t i = 0; i < call.list.count; ++i) {
    if (tree_.args[call.list.first + i].output) return;  // ENO
  }
  warning(DiagnosticCode::kResultUnused, call.span, "nothing takes what this call gives",
          "assign it: `x := ...`");
}

void CallCode::call_statement(ExprId id, const Callee& callee) {
  const Expr& call = tree_[id];
  switch (callee.kind) {
    case Callee::Kind::kError:
      for (uint32_t i = 0; i < call.list.count; ++i) {
        ExprId value = tree_.args[call.list.first + i].value;
        if (value.valid()) infer(value);
      }
      return;
    case Callee::Kind::kInstance:
      return call_instance(call, callee.pou);
    case Callee::Kind::kBase:
      return call_base(call, callee.pou);
    case Callee::Kind::kFunction:
    case Callee::Kind::kMethod:
      call_function(call, callee, false);
      return;
    case Callee::Kind::kTest:
      return ask<TestCode>().test_call(call, *callee.test);
    case Callee::Kind::kStandard:
      if (callee.row != nullptr && callee.row->rule == stdlib::FunctionRule::kSplit)
        return ask<StandardCode>().split(call, *callee.row);
      [[fallthrough]];
    case Callee::Kind::kConversion:
      check_result_use(call);
      [[fallthrough]];
    case Callee::Kind::kBound:
    case Callee::Kind::kReference: {
      const Note& note = infer(id);
      if (!note.type.valid()) return;
      if (types().is_scalar(note.type)) {
        emit_call(call, callee, without_range(types(), note.type));
      } else {
        call_place(call, callee, note.type);
      }
      return;
    }
  }
}

ir::ValueId CallCode::emit_call(const Expr& expr, const Callee& callee, ir::TypeId own) {
  switch (callee.kind) {
    case Callee::Kind::kFunction:
    case Callee::Kind::kMethod: {
      ir::ValueId result = call_function(expr, callee, true).value;
      return result.valid() ? result : code_.zero(own);
    }
    case Callee::Kind::kStandard:
      return ask<StandardCode>().emit_standard(expr, callee, own);
    case Callee::Kind::kConversion:
      return ask<Conversions>().emit_conversion(expr, callee.conversion);
    case Callee::Kind::kReference:
      return ask<References>().emit_reference_call(expr, callee.reference, own);
    case Callee::Kind::kBound:
      return emit_bound(expr, callee.upper);
    default:
      return code_.zero(own);
  }
}

// UPPER_BOUND(a, n), where only the code knows n.
ir::ValueId CallCode::emit_bound(const Expr& call, bool upper) {
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  constexpr ir::Scalar kU64 = ir::Scalar::kU64;
  const ir::TypeId array = infer(tree_.args[call.list.first].value).type;
  const OpenArray* open = sema_.declared.open_array(array);
  std::vector<ir::Dimension> dims = types()[array].dims;
  if (open != nullptr) dims.resize(open->dims);
  const ExprId whole = tree_.args[call.list.first].value;
  const Typed given = natural(tree_.args[call.list.first + 1].value);
  const ir::ValueId number = code_.machine_convert(given.value, scalar(given.type), kI64);
  const ir::ValueId first = build_.constant(kI64, 1);
  // As one unsigned comparison: below 1 it is huge.
  const ir::ValueId at =
      build_.unary(ir::Op::kWrap, kU64, build_.binary(ir::Op::kSub, kI64, number, first));
  const ir::BlockId good = build_.new_block();
  const ir::BlockId bad = build_.new_block();
  build_.branch(build_.compare(ir::Op::kLt, kU64, at, build_.constant(kU64, dims.size())), good,
                bad);
  build_.start(bad);
  build_.trap(ir::TrapKind::kIndex);
  build_.start(good);
  ir::ValueId bound;
  for (size_t i = dims.size(); i-- > 0;) {
    const int64_t one = upper ? dims[i].high : dims[i].low;
    const ir::ValueId value = open != nullptr
                                  ? ask<Places>().open_bound(whole, static_cast<uint32_t>(i), upper)
                                  : build_.constant(ir::Scalar::kI32, static_cast<uint64_t>(one));
    if (!bound.valid()) {
      bound = value;
      continue;
    }
    const ir::ValueId here = build_.compare(ir::Op::kEq, kU64, at, build_.constant(kU64, i));
    bound = build_.select(ir::Scalar::kI32, here, bound, value);
  }
  return bound;
}

// A result that is no scalar.
ir::Place CallCode::call_place(const Expr& expr, const Callee& callee, ir::TypeId type) {
  if (callee.kind == Callee::Kind::kFunction || callee.kind == Callee::Kind::kMethod) {
    CallResult result = call_function(expr, callee, true);
    return result.place.type.valid() ? result.place : temporary_place(type);
  }
  if (callee.kind == Callee::Kind::kConversion)
    return ask<Conversions>().to_string(expr, callee.conversion, type);
  if (callee.kind != Callee::Kind::kStandard) return temporary_place(type);
  std::vector<ExprId> args = ask<StandardCalls>().standard_arguments(expr, *callee.row);
  using stdlib::FunctionRule;
  switch (callee.row->rule) {
    case FunctionRule::kMove:
      return place(args[0]);
    case FunctionRule::kSelect:
    case FunctionRule::kMux:
      return ask<StandardCode>().choose(args, *callee.row, type);
    case FunctionRule::kExtreme:
      return ask<StandardCode>().extreme_string(args, *callee.row, type);
    case FunctionRule::kString:
      return ask<StandardCode>().string_function(args, *callee.row, type);
    case FunctionRule::kNumberSame:
    case FunctionRule::kReal:
    case FunctionRule::kTrunc:
    case FunctionRule::kArithmetic:
    case FunctionRule::kShift:
    case FunctionRule::kBitwise:
    case FunctionRule::kNot:
    case FunctionRule::kCompare:
    case FunctionRule::kStringNumber:
    case FunctionRule::kClock:
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
    case FunctionRule::kMoment:
    case FunctionRule::kSplit:
    case FunctionRule::kWeekday:
    case FunctionRule::kByteOrder:
    case FunctionRule::kValid:
      break;  // scalars
  }
  error(DiagnosticCode::kNotSupported, expr.span,
        std::string(callee.row->name) + " of `" + sema_.report.type_text(type) + "`");
  return temporary_place(type);
}

// With EN and ENO around it.
ir::ValueId CallCode::emit_call(const Expr& expr, ir::TypeId own) {
  Callee callee = ask<Calls>().callee(expr);
  auto enable = ask<EnableCode>().enable_of(expr, callee);
  if (!enable) return emit_call(expr, callee, own);
  ask<EnableCode>().open_enable(*enable);
  ir::ValueId result = build_.add_param(enable->done, scalar(own));
  ir::ValueId value = emit_call(expr, callee, own);
  uint64_t otherwise = ask<EnableCode>().default_bits(own);
  if (callee.kind == Callee::Kind::kFunction && sema_.declared.pous[callee.pou].result.valid()) {
    const Variable& declared = resolve(sema_.declared.pous[callee.pou].result);
    otherwise = declared.init.valid() ? sema_.program.constants[declared.init].bits
                                      : ask<EnableCode>().default_bits(declared.type);
  }
  ask<EnableCode>().close_enable(*enable, {value}, own, otherwise);
  return result;
}

// A result that is no scalar.
ir::Place CallCode::call_place(ExprId id, const Expr& expr) {
  ir::TypeId type = infer(id).type;
  Callee callee = ask<Calls>().callee(expr);
  auto enable = ask<EnableCode>().enable_of(expr, callee);
  if (!enable) return call_place(expr, callee, type);
  ir::Place result = temporary_place(type);
  build_.init(result, {});
  ask<EnableCode>().open_enable(*enable);
  build_.copy(result, call_place(expr, callee, type));
  ask<EnableCode>().close_enable(*enable, {}, {});
  return result;
}

void CallCode::call_statement(const Stmt& stmt) {
  const Expr& call = tree_[stmt.value];
  if (call.kind != ExprKind::kCall) return ask<MethodCode>().bare_call(stmt.value);
  Callee callee = ask<Calls>().callee(call);
  auto enable = ask<EnableCode>().enable_of(call, callee);
  if (!enable) return call_statement(stmt.value, callee);
  ask<EnableCode>().open_enable(*enable);
  call_statement(stmt.value, callee);
  ask<EnableCode>().close_enable(*enable, {}, {});
}

}  // namespace frontend
