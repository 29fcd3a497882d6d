// Arguments of POUs: which goes to which parameter.
#include "frontend/lower/arguments.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/positional.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {

std::string quoted_name(const Name& name) { return "`" + std::string(name.text) + "`"; }

// Arguments without names come first and go to parameters in order; names may follow.
bool Arguments::bind_arguments(const Expr& call, const PouInfo& callee,
                               std::vector<Binding>& bindings) {
  uint32_t positional = 0;
  while (positional < call.list.count && tree_.args[call.list.first + positional].name.empty()) {
    ++positional;
  }
  if (positional != 0 && !bind_positional(call, positional, callee, bindings)) return false;
  bool good = true;
  for (uint32_t i = positional; i < call.list.count; ++i) {
    const Arg& arg = tree_.args[call.list.first + i];
    if (arg.name.empty()) {
      error(DiagnosticCode::kMixedArguments, arg.span,
            "an argument without a name after one with a name", "name it too");
      return false;
    }
    good = bind_named(arg, callee, bindings) && good;
  }
  return good;
}

bool Arguments::bind_named(const Arg& arg, const PouInfo& callee, std::vector<Binding>& bindings) {
  if (ask<Calls>().is_enable(arg, &callee)) return true;
  const VarId found = ask<Objects>().find_parameter(callee, arg.name.text);
  const bool known = found.valid() && found != callee.result;
  const Variable* variable = known ? &resolve(found) : nullptr;
  bool parameter = variable != nullptr && (variable->section == VarSection::kInput ||
                                           variable->section == VarSection::kOutput ||
                                           variable->section == VarSection::kInOut);
  if (!parameter) {
    NearestName nearest(arg.name.text);
    for (VarId id : ask<Objects>().variables_of(callee)) {
      VarSection section = resolve(id).section;
      if (section == VarSection::kInput || section == VarSection::kOutput ||
          section == VarSection::kInOut) {
        nearest.offer(resolve(id).name.text);
      }
    }
    error(DiagnosticCode::kUnknownParameter, arg.name.span,
          quoted_name(callee.decl->name) + " has no parameter " + quoted_name(arg.name),
          nearest.fix());
    return false;
  }
  for (const Binding& other : bindings) {
    if (other.variable != found) continue;
    error(DiagnosticCode::kDuplicateArgument, arg.span, quoted_name(arg.name) + " is given twice");
    return false;
  }
  if (arg.output != (variable->section == VarSection::kOutput)) {
    error(DiagnosticCode::kWrongDirection, arg.span,
          quoted_name(arg.name) + (arg.output ? " is no output" : " is an output"),
          arg.output ? "write `:=`" : "write `=>`");
    return false;
  }
  if (!arg.value.valid()) return true;  // `name :=` and `name =>` leave the parameter open
  bindings.push_back({found, &arg, {}, {}, {}});
  return true;
}

bool Arguments::bind_positional(const Expr& call, uint32_t count, const PouInfo& callee,
                                std::vector<Binding>& bindings) {
  const std::vector<VarId> variables = ask<Objects>().variables_of(callee);
  const auto parameters_for = [&](uint32_t given) {
    return positional_parameters(sema_.declared, variables, callee.result, given);
  };
  const std::vector<VarId> parameters = parameters_for(count);
  if (count > parameters.size()) {
    error(DiagnosticCode::kWrongArgumentCount, call.span,
          quoted_name(callee.decl->name) + " has " + std::to_string(parameters.size()) +
              " parameters, but " + std::to_string(count) + " arguments are given");
    return false;
  }
  const bool reaches_outputs = resolve(parameters[count - 1]).section == VarSection::kOutput;
  if (reaches_outputs && parameters != parameters_for(static_cast<uint32_t>(parameters.size()))) {
    error(DiagnosticCode::kWrongArgumentCount, call.span,
          quoted_name(callee.decl->name) + " has " + std::to_string(parameters.size()) +
              " parameters, an output in front of others, so " + std::to_string(count) +
              " arguments without names are ambiguous",
          "give all in the order of their declaration, or outputs by name: `" +
              std::string(resolve(parameters[count - 1]).name.text) + " => variable`");
    return false;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const Arg& arg = tree_.args[call.list.first + i];
    if (arg.value.valid()) bindings.push_back({parameters[i], &arg, {}, {}, {}});
  }
  return true;
}

// A call without names gives every input that has no initial value of its own.
bool Arguments::check_given(const Expr& call, const PouInfo& callee,
                            const std::vector<Binding>& bindings) {
  if (call.list.count == 0 || !tree_.args[call.list.first].name.empty()) return true;
  std::string missing;
  for (VarId id : ask<Objects>().variables_of(callee)) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInput) continue;
    if (variable.decl != nullptr && variable.decl->init.valid()) continue;
    bool given = false;
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (!given) missing += (missing.empty() ? "" : ", ") + quoted_name(variable.name);
  }
  if (missing.empty()) return true;
  error(DiagnosticCode::kWrongArgumentCount, call.span,
        "this call of " + quoted_name(callee.decl->name) + " leaves out " + missing,
        "give every input, or name those that are given: `" + std::string(callee.decl->name.text) +
            "(name := value)`");
  return false;
}

// In-outs have to be connected at every call: their slot keeps no meaning between calls.
bool Arguments::check_in_outs(const Expr& call, const PouInfo& callee,
                              const std::vector<Binding>& bindings) {
  bool good = true;
  for (VarId id : ask<Objects>().variables_of(callee)) {
    const Variable& variable = resolve(id);
    if (variable.section != VarSection::kInOut) continue;
    bool given = false;
    for (const Binding& binding : bindings) given = given || binding.variable == id;
    if (given) continue;
    error(DiagnosticCode::kMissingInOut, call.span,
          "in-out " + quoted_name(variable.name) + " of " + quoted_name(callee.decl->name) +
              " is not connected",
          "add `" + std::string(variable.name.text) + " := variable`");
    good = false;
  }
  return good;
}

}  // namespace frontend
