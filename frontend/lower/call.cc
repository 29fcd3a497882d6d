// Calls of functions and function block instances, by the call discipline of
// ir/program/ir.h: everything is evaluated first, then passed, then called.
#include "frontend/lower/call.h"
#include "frontend/lower/body.h"
#include "frontend/lower/conversions.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/write_checks.h"
#include "frontend/sema/constants.h"
#include "frontend/sema/standard_calls.h"

namespace frontend {
namespace {

ir::Step member_step(uint32_t index) {
  ir::Step step;
  step.kind = ir::StepKind::kMember;
  step.index = index;
  return step;
}

}  // namespace

// `keep`: a later argument calls something that might change this one's source.
void Body::evaluate_input(Binding& binding, bool keep) {
  const Variable& parameter = resolve(binding.variable);
  if (!parameter.type.valid()) return;
  ExprId id = binding.arg->value;
  if (types().is_scalar(parameter.type)) {
    binding.value = value(id, parameter.type);
    return;
  }
  ExprKind kind = tree_[id].kind;
  if (kind == ExprKind::kArrayInit || kind == ExprKind::kStructInit) {
    ir::Place list;
    list.base = ir::PlaceBase::kConst;
    list.base_type = list.type = parameter.type;
    list.constant = ask<Constants>().initial_value(id, parameter.type, {}, Known::kByCall);
    if (list.constant.valid()) binding.place = list;
    return;
  }
  const Note& note = infer(id);
  if (!note.type.valid()) return;
  bool strings =
      is_string(types(), parameter.type) && types()[note.type].kind == types()[parameter.type].kind;
  if (!strings && note.type != parameter.type) {
    error(DiagnosticCode::kWrongArgument, binding.arg->span,
          quoted_name(parameter.name) + " is `" + sema_.report.type_text(parameter.type) +
              "`, the argument is `" + sema_.report.type_text(note.type) + "`");
    return;
  }
  binding.place = place(id);
  if (!keep || note.constant) return;
  ir::Place kept = temporary_place(note.type);
  build_.copy(kept, *binding.place);
  binding.place = kept;
}

// A CONSTANT in-out of a value that has no place of its own.
bool Body::evaluate_read_only(Binding& binding) {
  Binding given = binding;
  evaluate_input(given, false);
  if (!given.place && !given.value.valid()) return false;
  const ir::TypeId type = resolve(binding.variable).type;
  const ir::Place read = temporary_place(type);
  if (given.place) {
    build_.copy(read, *given.place);
  } else {
    build_.store(read, scalar(type), given.value);
  }
  binding.value = build_.address(read);
  return true;
}

bool Body::evaluate_in_out(Binding& binding) {
  const Variable& parameter = resolve(binding.variable);
  ExprId id = binding.arg->value;
  const Note& note = infer(id);
  if (!note.type.valid() || !parameter.type.valid()) return false;
  if (parameter.by_reference) {
    binding.value = ask<References>().reference_value(id, parameter.type);
    return true;
  }
  const bool convertible = types().is_scalar(note.type) || is_string(types(), note.type);
  const bool copied =
      !ask<WriteChecks>().has_address(id) || (convertible && note.type != parameter.type);
  if (parameter.constant && copied) return evaluate_read_only(binding);
  if (!parameter.constant && !ask<WriteChecks>().check_writable(id)) return false;
  if (note.bit_size != 0 || ask<Places>().is_character(id)) {
    error(DiagnosticCode::kInOutNeedsVariable, binding.arg->span,
          quoted_name(parameter.name) + " cannot be bound to a part of a variable",
          "copy the part into a variable of its own and pass that");
    return false;
  }
  if (note.type != parameter.type) {
    error(DiagnosticCode::kInOutNeedsVariable, binding.arg->span,
          quoted_name(parameter.name) + " is `" + sema_.report.type_text(parameter.type) +
              "`, the argument is `" + sema_.report.type_text(note.type) + "`",
          "pass a variable of exactly this type");
    return false;
  }
  binding.value = build_.address(place(id));
  return true;
}

// Lists are constants.
bool Body::may_call(ExprId id) {
  ExprKind kind = tree_[id].kind;
  bool list = kind == ExprKind::kArrayInit || kind == ExprKind::kStructInit;
  return !list && infer(id).calls;
}

void Body::evaluate_arguments(const Expr& call, std::vector<Binding>& bindings) {
  for (size_t i = 0; i < bindings.size(); ++i) {
    Binding& binding = bindings[i];
    VarSection section = resolve(binding.variable).section;
    if (section == VarSection::kInOut) {
      evaluate_in_out(binding);
    } else if (section == VarSection::kOutput) {
      binding.target = target(binding.arg->value);
    } else {
      bool keep = false;
      for (size_t k = i + 1; k < bindings.size(); ++k) {
        keep = keep || may_call(bindings[k].arg->value);
      }
      evaluate_input(binding, keep);
    }
  }
  set_line(call.span);
}

void Body::pass_input(const Binding& binding, const ir::Place& parameter) {
  const Variable& variable = resolve(binding.variable);
  if (variable.section == VarSection::kInOut && !variable.by_reference) {
    if (binding.value.valid()) build_.store(parameter, ir::Scalar::kAddr, binding.value);
  } else if (binding.place) {
    build_.copy(parameter, *binding.place);
  } else if (binding.value.valid()) {
    build_.store(parameter, scalar(variable.type), binding.value);
  }
}

// Results are read before anything else can call: first all loads, then all stores.
void Body::take_outputs(std::vector<Binding>& bindings,
                        const std::function<ir::Place(const Variable&)>& place_of) {
  for (Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput || !binding.target || !variable.type.valid()) {
      continue;
    }
    if (types().is_scalar(variable.type)) {
      binding.value = build_.load(place_of(variable), scalar(variable.type));
      continue;
    }
    bool strings = is_string(types(), variable.type) && is_string(types(), binding.target->type) &&
                   wide(variable.type) == wide(binding.target->type);
    if (strings || variable.type == binding.target->type) {
      build_.copy(binding.target->place, place_of(variable));
      continue;
    }
    error(DiagnosticCode::kWrongArgument, binding.arg->span,
          quoted_name(variable.name) + " is `" + sema_.report.type_text(variable.type) +
              "`, its target is `" + sema_.report.type_text(binding.target->type) + "`");
  }
  for (Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput || !binding.target) continue;
    settle(*binding.target);
    if (!binding.value.valid()) continue;
    ir::ValueId out = binding.value;
    if (binding.arg->negated) out = build_.unary(ir::Op::kNot, scalar(variable.type), out);
    if (!types().is_scalar(binding.target->type)) {
      error(DiagnosticCode::kWrongArgument, binding.arg->span,
            "the target of " + quoted_name(variable.name) + " is no `" +
                sema_.report.type_text(variable.type) + "`");
      continue;
    }
    store(*binding.target, convert({out, variable.type}, binding.target->type, binding.arg->span));
  }
}

void Body::call_instance(const Expr& call, uint32_t pou) {
  const PouInfo& block = sema_.declared.pous[pou];
  info_.callees.push_back(pou);
  std::vector<Binding> bindings;
  bool good = bind_arguments(call, block, bindings) && check_in_outs(call, block, bindings);
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
  evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput) pass_input(binding, place_of(variable));
  }
  build_.call_instance(instance);
  take_outputs(bindings, place_of);
}

// SUPER^(): parameters are members of the own instance.
void Body::call_base(const Expr& call, uint32_t pou) {
  const PouInfo& base = sema_.declared.pous[pou];
  info_.callees.push_back(pou);
  std::vector<Binding> bindings;
  if (!bind_arguments(call, base, bindings)) return;
  auto place_of = [&](const Variable& variable) { return member_variable_place(variable); };
  evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput) pass_input(binding, place_of(variable));
  }
  build_.call_body(base.id);
  take_outputs(bindings, place_of);
}

void Body::pass_defaults(const PouInfo& callee, const std::vector<Binding>& bindings) {
  for (VarId id : callee.locals) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInput || !variable.type.valid()) continue;
    bool given = false;
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (given) continue;
    ir::Place parameter = argument_place(callee, variable);
    if (!types().is_scalar(variable.type)) {
      build_.init(parameter, variable.init);
      continue;
    }
    ir::ConstId init = variable.init.valid() ? variable.init : types()[variable.type].init;
    uint64_t bits = init.valid() ? sema_.program.constants[init].bits : 0;
    ir::Scalar machine = scalar(variable.type);
    build_.store(parameter, machine, build_.constant(machine, bits));
  }
}

ir::Place Body::argument_place(const PouInfo& callee, const Variable& variable) const {
  ir::Place out;
  out.base = ir::PlaceBase::kArg;
  out.base_index = variable.index;
  out.pou = callee.id;
  out.base_type = out.type = variable.type;
  return out;
}

CallResult Body::call_function(const Expr& call, const Callee& callee, bool wants_result) {
  const PouInfo& function = sema_.declared.pous[callee.pou];
  const bool method = callee.kind == Callee::Kind::kMethod;
  if (!method) info_.callees.push_back(callee.pou);
  std::vector<Binding> bindings;
  CallResult result;
  bool good = bind_arguments(call, function, bindings) && check_in_outs(call, function, bindings) &&
              check_given(call, function, bindings);
  if (!good) return result;
  Receiver receiver;
  if (method) {
    receiver = receiver_of(tree_[call.operand]);
    prepare_receiver(function, receiver);
  }
  evaluate_arguments(call, bindings);
  for (const Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput) {
      pass_input(binding, argument_place(function, variable));
    }
  }
  pass_defaults(function, bindings);
  if (method) {
    emit_method_call(function, receiver);
  } else {
    build_.call_function(function.id);
  }
  if (wants_result && function.result.valid()) result = result_of(function);
  take_outputs(bindings,
               [&](const Variable& variable) { return argument_place(function, variable); });
  return result;
}

// Warns when the result of a function that only computes is not used.
void Body::check_result_use(const Expr& call) {
  for (uint32_t i = 0; i < call.list.count; ++i) {
    if (tree_.args[call.list.first + i].output) return;  // ENO
  }
  warning(DiagnosticCode::kResultUnused, call.span, "nothing takes what this call gives",
          "assign it: `x := ...`");
}

void Body::call_statement(ExprId id, const Callee& callee) {
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
      return test_call(call, *callee.test);
    case Callee::Kind::kStandard:
      if (callee.row != nullptr && callee.row->rule == stdlib::FunctionRule::kSplit)
        return split(call, *callee.row);
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

ir::ValueId Body::emit_call(const Expr& expr, const Callee& callee, ir::TypeId own) {
  switch (callee.kind) {
    case Callee::Kind::kFunction:
    case Callee::Kind::kMethod: {
      ir::ValueId result = call_function(expr, callee, true).value;
      return result.valid() ? result : code_.zero(own);
    }
    case Callee::Kind::kStandard:
      return emit_standard(expr, callee, own);
    case Callee::Kind::kConversion:
      return ask<Conversions>().emit_conversion(expr, callee.conversion);
    case Callee::Kind::kReference:
      return ask<References>().emit_reference_call(expr, callee.reference, own);
    default:
      return code_.zero(own);
  }
}

// A result that is no scalar.
ir::Place Body::call_place(const Expr& expr, const Callee& callee, ir::TypeId type) {
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
      return choose(args, *callee.row, type);
    case FunctionRule::kExtreme:
      return extreme_string(args, *callee.row, type);
    case FunctionRule::kString:
      return string_function(args, *callee.row, type);
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

}  // namespace frontend
