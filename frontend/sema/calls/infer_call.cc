// Calls: what is called, and what it gives back.
#include <algorithm>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/open_functions.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/declarations/collection.h"
#include "frontend/sema/declarations/variables.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/objects/objects.h"
#include "frontend/sema/quoted.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// C of A.B.C
std::string_view last_name(const Name& path) {
  size_t dot = path.text.rfind('.');
  return dot == std::string_view::npos ? path.text : path.text.substr(dot + 1);
}

}  // namespace

Callee Calls::callee(const Expr& call) {
  if (call.open_list) {
    allow_extension("a comma behind the last argument", call.span, "take it away");
  }
  const Expr& head = sema_.tree[call.operand];
  if (head.kind == ExprKind::kName) {
    VarId id = ask<Variables>().find_variable(head);
    if (!id.valid() && !head.global) {
      if (auto method = ask<Objects>().method_of(sema_.declared.block_of(scope_), head.name))
        return *method;
    }
    if (!id.valid()) id = ask<Variables>().program_variable(head.name.text, true);
    if (!id.valid()) {
      return named_callee(call, head);
    }
    // The function's own name is its result inside; calling it is recursion.
    if (scope_.pou != nullptr && id == scope_.pou->result) return ask<Objects>().itself(head);
    // A variable may have a function's name; calls then still mean the function.
    bool instance = sema_.declared.pou_of(resolve(id).type) != nullptr;
    if (!instance && sema_.library.functions.contains(head.name.text))
      return named_callee(call, head);
  }
  if (sema_.namespaces.declares(scope_, head)) return named_callee(call, head);
  if (ask<Objects>().is_super(head)) return ask<Objects>().base_body(head);
  if (head.kind == ExprKind::kMember &&
      !sema_.namespaces.is_scope(scope_, sema_.tree[head.operand])) {
    const uint32_t owner = ask<Objects>().receiver(head.operand);
    if (auto method = ask<Objects>().method_of(owner, head.name)) {
      return ask<Objects>().refuse_change(head.operand) ? Callee() : *method;
    }
  }
  const Note& note = infer(call.operand);
  if (!note.type.valid()) return {};
  const PouInfo* block = sema_.declared.pou_of(note.type);
  if (block == nullptr) {
    const VarDecl* decl =
        note.variable.valid() ? sema_.declared.variables[note.variable.index].decl : nullptr;
    bool chart = decl != nullptr && decl->implied;
    error(DiagnosticCode::kNotCallable, head.span,
          chart ? quoted(head.name) + " belongs to the chart, whose steps alone run its actions"
                : "`" + sema_.report.type_text(note.type) + "` cannot be called",
          chart              ? "put what several places call into a function or function block"
          : call.instruction ? "write LD in front of it to load it"
                             : "");
    return {};
  }
  if (block->decl->kind == PouKind::kClass) {
    error(DiagnosticCode::kNotCallable, head.span,
          quoted(block->decl->name) + " is a class and has no body", "call a method of it");
    return {};
  }
  const Name box = sema_.tree.name(call.number);
  if (std::string_view type = last_name(box); !type.empty() &&
                                              !ir::same_name(type, block->decl->name.text) &&
                                              !sema_.declared.types.contains(type)) {
    error(DiagnosticCode::kOtherBoxType, box.span,
          "the instance is a " + quoted(block->decl->name) + ", its box says " + quoted(box),
          "write " + quoted(block->decl->name) + ", or declare the instance as " + quoted(box));
  }
  Callee callee;
  if (ask<Objects>().refuse_change(call.operand)) return callee;
  callee.kind = Callee::Kind::kInstance;
  callee.pou = static_cast<uint32_t>(sema_.declared.pou_by_type.find(note.type)->second);
  return callee;
}

// f or A.f
Callee Calls::named_callee(const Expr& call, const Expr& head) {
  Callee callee;
  const std::string_view name = sema_.namespaces.find(NameSort::kDeclaration, scope_, head);
  bool known = sema_.declared.pou_names.contains(name);
  if (!known && !sema_.library.functions.contains(name))
    known = ask<Collection>().use_library(name);
  if (known) {
    uint32_t number = sema_.declared.pou_names.find(name)->second;
    if (sema_.declared.pous[number].decl->kind == PouKind::kFunction) {
      return ask<OpenFunctions>().select_function(call, number);
    }
    bool block = sema_.declared.pous[number].decl->kind == PouKind::kFunctionBlock;
    error(block ? DiagnosticCode::kNeedsInstance : DiagnosticCode::kNotCallable, head.span,
          quoted(head.name) + (block ? " is a function block" : " is a program"),
          block ? "declare an instance of it and call that" : "let a task run it");
    return callee;
  }
  if (auto found = sema_.library.functions.find(name); found != sema_.library.functions.end()) {
    callee.kind = Callee::Kind::kStandard;
    callee.row = found->second;
    return callee;
  }
  bool upper = ir::same_name(name, "UPPER_BOUND");
  if (upper || ir::same_name(name, "LOWER_BOUND")) {
    callee.kind = Callee::Kind::kBound;
    callee.upper = upper;
    return callee;
  }
  if (auto conversion = conversion_of_name(name)) {
    callee.kind = Callee::Kind::kConversion;
    callee.conversion = *conversion;
    return callee;
  }
  if (auto conversion = ask<StandardCalls>().conversion_to_enumeration(name)) {
    callee.kind = Callee::Kind::kConversion;
    callee.conversion = *conversion;
    return callee;
  }
  if (Callee typed = typed_callee(name); typed.row != nullptr) return typed;
  if (auto reference = reference_call_of_name(name); reference != ReferenceCall::kNone) {
    callee.kind = Callee::Kind::kReference;
    callee.reference = reference;
    return callee;
  }
  if (const TestCallRow* test = find_test_call(name)) {
    if (sema_.for_tests() || test->call == TestCall::kAssert) {
      callee.kind = Callee::Kind::kTest;
      callee.test = test;
    } else {
      error(DiagnosticCode::kTestOnly, head.span, quoted(head.name) + " is for tests only",
            "put it into a TEST block and run that with stc test");
    }
    return callee;
  }
  error(DiagnosticCode::kUnknownName, head.span, "`" + std::string(name) + "` is not declared",
        ask<Variables>().name_suggestion(name, true, head.instruction));
  return callee;
}

Note Calls::infer_call(const Expr& expr) {
  Callee target = callee(expr);
  Note note;
  switch (target.kind) {
    case Callee::Kind::kError:
      return {};
    case Callee::Kind::kStandard:
      return ask<StandardCalls>().infer_standard(expr, target);
    case Callee::Kind::kConversion:
      return ask<StandardCalls>().infer_conversion(expr, target.conversion);
    case Callee::Kind::kBound:
      return infer_bound(expr, target.upper);
    case Callee::Kind::kReference:
      return infer_reference_call(expr, target.reference);
    case Callee::Kind::kTest:
      error(DiagnosticCode::kNoResult, expr.span, "an assertion has no result",
            "write it as a statement of its own");
      return {};
    case Callee::Kind::kInstance:
    case Callee::Kind::kBase:
      error(DiagnosticCode::kNoResult, expr.span, "a function block has no result",
            "call it in a statement of its own and read its outputs");
      return {};
    case Callee::Kind::kFunction:
    case Callee::Kind::kMethod:
      break;
  }
  const PouInfo& function = sema_.declared.pous[target.pou];
  note.calls = true;
  if (!function.result.valid()) {
    error(
        DiagnosticCode::kNoResult, expr.span, quoted(function.decl->name) + " has no result",
        "call it in a statement of its own, or give it a result type; a box of a ladder without a "
        "result has `EN:=_` and `ENO=>_`");
    return {};
  }
  note.type = resolve(function.result).type;
  return note;
}

Note OperatorTypes::unify_arguments(const std::vector<ExprId>& args, uint32_t first) {
  Note note = infer(args[first]);
  for (uint32_t i = first + 1; i < args.size(); ++i) {
    note = unify(note, infer(args[i]), sema_.tree[args[i]].span);
    if (!note.type.valid()) return {};
  }
  note.variable = {};
  note.constant = false;
  note.progress = Progress::kNew;
  return note;
}

}  // namespace frontend
