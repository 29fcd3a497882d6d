// Arguments on their way: evaluated from left to right, passed when all are known, outputs taken
// after the call.
#include <algorithm>

#include "frontend/lower/arguments.h"
#include "frontend/lower/assignments.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/places.h"
#include "frontend/lower/references.h"
#include "frontend/lower/write_checks.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/objects/objects.h"
#include "ir/types/parts.h"

namespace frontend {

// `keep`: a later argument calls something that might change this one's source.
void Arguments::evaluate_input(Binding& binding, bool keep) {
  const Variable& parameter = resolve(binding.variable);
  if (!parameter.type.valid()) return;
  if (parameter.takes_any) return evaluate_any(binding);
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
  const bool held = ir::holds_instance(types(), note.type);  // it has no place but its own
  if (held && ask<Assignments>().refuse_copy(note.type, binding.arg->span)) return;
  binding.place = place(id);
  if (!keep || note.constant || held) return;
  ir::Place kept = temporary_place(note.type);
  build_.copy(kept, *binding.place);
  binding.place = kept;
}

// A CONSTANT in-out of a value that has no place of its own.
bool Arguments::evaluate_read_only(Binding& binding) {
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

bool Arguments::evaluate_in_out(Binding& binding) {
  const Variable& parameter = resolve(binding.variable);
  ExprId id = binding.arg->value;
  const Note& note = infer(id);
  if (!note.type.valid() || !parameter.type.valid()) return false;
  if (const OpenArray* open = sema_.declared.open_array(parameter.type)) {
    return evaluate_open_array(binding, *open);
  }
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
bool Arguments::may_call(ExprId id) {
  ExprKind kind = tree_[id].kind;
  bool list = kind == ExprKind::kArrayInit || kind == ExprKind::kStructInit;
  return !list && infer(id).calls;
}

void Arguments::evaluate_arguments(const Expr& call, std::vector<Binding>& bindings) {
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

void Arguments::pass_input(const Binding& binding, const ir::Place& parameter) {
  const Variable& variable = resolve(binding.variable);
  if (variable.section == VarSection::kInOut && !variable.by_reference) {
    if (binding.value.valid()) build_.store(parameter, ir::Scalar::kAddr, binding.value);
  } else if (binding.place) {
    ask<Assignments>().copy_held(parameter, *binding.place, variable.type);
  } else if (binding.value.valid()) {
    build_.store(parameter, scalar(variable.type), binding.value);
  }
}

// Results are read before anything else can call: first all loads, then all stores.
void Arguments::take_outputs(std::vector<Binding>& bindings,
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
      if (ir::holds_instance(types(), variable.type) &&
          ask<Assignments>().refuse_copy(variable.type, binding.arg->span)) {
        continue;
      }
      ask<Assignments>().copy_held(binding.target->place, place_of(variable), binding.target->type);
      continue;
    }
    error(DiagnosticCode::kWrongArgument, binding.arg->span,
          quoted_name(variable.name) + " is `" + sema_.report.type_text(variable.type) +
              "`, its target is `" + sema_.report.type_text(binding.target->type) + "`");
  }
  for (Binding& binding : bindings) {
    const Variable& variable = resolve(binding.variable);
    if (variable.section != VarSection::kOutput || !binding.target) continue;
    ask<MethodCode>().settle(*binding.target);
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

void Arguments::pass_defaults(const PouInfo& callee, const std::vector<Binding>& bindings) {
  for (VarId id : callee.locals) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInput || !variable.type.valid()) continue;
    if (!is_given(id, bindings)) pass_default(callee, variable, argument_place(callee, variable));
  }
}

// With 'initialize_on_call', an input that this call leaves out does not keep its value.
void Arguments::pass_initial_inputs(const PouInfo& block, const std::vector<Binding>& bindings,
                                    const std::function<ir::Place(const Variable&)>& place_of) {
  for (VarId id : ask<Objects>().variables_of(block)) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInput || !variable.type.valid()) continue;
    if (variable.decl == nullptr || variable.decl->attributes.count == 0) continue;
    const bool again =
        tree_.find_attribute(variable.decl->attributes, kInitializeOnCall) != nullptr;
    if (again && !is_given(id, bindings)) pass_default(block, variable, place_of(variable));
  }
}

bool Arguments::is_given(VarId parameter, const std::vector<Binding>& bindings) const {
  return std::any_of(bindings.begin(), bindings.end(),
                     [&](const Binding& binding) { return binding.variable == parameter; });
}

void Arguments::pass_default(const PouInfo& callee, const Variable& variable,
                             const ir::Place& parameter) {
  hold(callee);
  if (!types().is_scalar(variable.type)) return build_.init(parameter, variable.init);
  const ir::ConstId init = variable.init.valid() ? variable.init : types()[variable.type].init;
  const uint64_t bits = init.valid() ? sema_.program.constants[init].bits : 0;
  const ir::Scalar machine = scalar(variable.type);
  build_.store(parameter, machine, build_.constant(machine, bits));
}

// The code here has a value of the callee's unit, so it goes with another version of it no more.
void Arguments::hold(const PouInfo& callee) {
  const ir::PouId unit = callee.owner == kNoPou ? callee.id : sema_.declared.pous[callee.owner].id;
  std::vector<ir::PouId>& held = body_.out.taken_in;
  if (callee.library || !unit.valid() || unit == info_.id) return;
  if (std::find(held.begin(), held.end(), unit) == held.end()) held.push_back(unit);
}

ir::Place Arguments::argument_place(const PouInfo& callee, const Variable& variable) const {
  ir::Place out;
  out.base = ir::PlaceBase::kArg;
  out.base_index = variable.index;
  out.pou = callee.id;
  out.base_type = out.type = variable.type;
  return out;
}

}  // namespace frontend
