// Calls of methods, actions and bodies of bases, and properties, by "Objects" in
// ir/program/ir.h. Where the type of the instance is known, its method is called; a
// reference, an interface variable or THIS may lead to a derived one that has another.
#include "frontend/lower/arguments.h"
#include "frontend/lower/call_code.h"
#include "frontend/lower/method_code.h"
#include "frontend/lower/references.h"
#include "frontend/parse/foreign_words.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/objects/objects.h"

namespace frontend {

// The instance whose method `x.m` or `m` is; evaluates x.
Receiver MethodCode::receiver_of(const Expr& head) {
  Receiver receiver;
  if (head.kind != ExprKind::kMember) return receiver;
  const ExprId id = head.operand;
  const Expr& operand = tree_[id];
  if (ask<Objects>().is_own(operand)) {
    receiver.fixed = ask<Objects>().is_super(operand);
    return receiver;
  }
  const Note& note = infer(id);
  const bool interface = is_interface(types(), note.type) && !note.reference.valid();
  const bool indexed =
      operand.kind == ExprKind::kIndex && types().is_reference(infer(operand.operand).type);
  if (interface) {
    receiver.handle = natural(id).value;
  } else if (note.reference.valid() && is_interface(types(), note.type)) {
    receiver.handle = build_.load(place(id), ir::Scalar::kU64);
  } else if (note.reference.valid() || operand.kind == ExprKind::kDeref || indexed) {
    receiver.handle = ask<References>().handle_of(id);
  } else {
    receiver.place = place(id);
  }
  return receiver;
}

bool MethodCode::is_virtual(const PouInfo& method, const Receiver& receiver) const {
  if (sema_.declared.pous[method.owner].decl->kind == PouKind::kInterface) return true;
  if (receiver.fixed || receiver.place) return false;
  return method.decl->is_abstract || !method.overrides.empty();
}

// Before arguments are passed: what a virtual call needs.
void MethodCode::prepare_receiver(const PouInfo& method, Receiver& receiver) {
  info_.callees.push_back(method.number);
  if (!is_virtual(method, receiver)) return;
  info_.callees.insert(info_.callees.end(), method.overrides.begin(), method.overrides.end());
  if (!receiver.handle) receiver.handle = build_.this_handle();
}

void MethodCode::emit_method_call(const PouInfo& method, const Receiver& receiver) {
  if (is_virtual(method, receiver)) {
    build_.call_virtual(method.id, *receiver.handle);
  } else if (receiver.place) {
    build_.call_method(method.id, *receiver.place);
  } else if (receiver.handle) {
    build_.call_method(method.id, *receiver.handle);
  } else {
    build_.call_method(method.id);
  }
}

const MemberCode& MethodCode::property_code(ExprId id) {
  return sema_.declared.pous[infer(id).property].code.find(tree_[id].name.text)->second;
}

CallResult MethodCode::result_of(const PouInfo& callee) {
  CallResult result;
  if (!callee.result.valid()) return result;
  const Variable& variable = resolve(callee.result);
  if (variable.type.valid() && types().is_scalar(variable.type)) {
    result.value =
        build_.load(ask<Arguments>().argument_place(callee, variable), scalar(variable.type));
  } else if (variable.type.valid()) {
    result.place = temporary_place(variable.type);
    build_.copy(result.place, ask<Arguments>().argument_place(callee, variable));
  }
  return result;
}

CallResult MethodCode::get_property(uint32_t getter, Receiver receiver) {
  const PouInfo& accessor = sema_.declared.pous[getter];
  prepare_receiver(accessor, receiver);
  emit_method_call(accessor, receiver);
  return result_of(accessor);
}

// After an error.
CallResult MethodCode::nothing_read(ir::TypeId type) {
  CallResult result;
  if (types().is_scalar(type)) result.value = code_.zero(type);
  result.place = temporary_place(type);
  return result;
}

CallResult MethodCode::read_property(ExprId id) {
  const Expr& expr = tree_[id];
  const MemberCode& code = property_code(id);
  if (code.getter == kNoPou) {
    error(DiagnosticCode::kPropertyAccess, expr.name.span,
          quoted_name(expr.name) + " has no GET and cannot be read");
    return nothing_read(infer(id).type);
  }
  if (ask<Objects>().has_own_access(code) &&
      !ask<Objects>().check_access(sema_.declared.pous[code.getter], expr.name)) {
    return nothing_read(infer(id).type);
  }
  Receiver receiver = receiver_of(expr);
  set_line(expr.span);
  return get_property(code.getter, receiver);
}

// The whole property as an assignment's left side.
std::optional<Target> MethodCode::property_target(ExprId id) {
  const Expr& expr = tree_[id];
  const MemberCode& code = property_code(id);
  if (code.setter == kNoPou) {
    error(DiagnosticCode::kPropertyAccess, expr.name.span,
          quoted_name(expr.name) + " has no SET and cannot be written");
    return std::nullopt;
  }
  if (!ask<Objects>().check_access(sema_.declared.pous[code.setter], expr.name))
    return std::nullopt;
  const ir::TypeId type = infer(id).type;
  const VarId parameter = ask<Objects>().value_of(sema_.declared.pous[code.setter]);
  if (!parameter.valid() || resolve(parameter).type != type) return std::nullopt;  // said there
  Target out;
  out.getter = code.getter;
  out.setter = code.setter;
  out.receiver = receiver_of(expr);
  if (types().is_scalar(type)) {
    out.place.type = type;
  } else {
    out.place = temporary_place(type);
  }
  return out;
}

void MethodCode::set_property(const Target& target, std::optional<ir::ValueId> value) {
  const PouInfo& accessor = sema_.declared.pous[target.setter];
  const Variable& parameter = resolve(ask<Objects>().value_of(accessor));
  Receiver receiver = target.receiver;
  prepare_receiver(accessor, receiver);
  const ir::Place argument = ask<Arguments>().argument_place(accessor, parameter);
  if (value) {
    build_.store(argument, scalar(parameter.type), *value);
  } else {
    build_.copy(argument, target.place);
  }
  emit_method_call(accessor, receiver);
}

// What was put together in `target.place` goes to the setter.
void MethodCode::settle(const Target& target) {
  if (target.setter == kNoPou || types().is_scalar(target.place.type)) return;
  set_property(target, std::nullopt);
}

// `fb.act;` and `act;` call an action, or a method that needs no arguments.
void MethodCode::bare_call(ExprId id) {
  const Expr& expr = tree_[id];
  if (!ask<Objects>().names_method(expr)) {
    if (expr.kind == ExprKind::kMember && ask<Objects>().damaged(expr.operand)) return;
    const std::string fix = instead_of(expr.kind == ExprKind::kName ? expr.name.text : "");
    error(DiagnosticCode::kNoEffect, expr.span,
          "this is no statement: nothing is assigned or called",
          fix.empty() ? "write `:=` and a value, or `()` to call" : fix);
    return;
  }
  Expr call;
  call.kind = ExprKind::kCall;
  call.span = expr.span;
  call.operand = id;
  const Callee callee = ask<Calls>().callee(call);
  if (callee.kind == Callee::Kind::kMethod) ask<CallCode>().call_function(call, callee, false);
}

}  // namespace frontend
