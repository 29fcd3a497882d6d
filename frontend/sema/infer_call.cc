// Calls: what is called, and what it gives back.
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

std::string quoted(const Name& name) { return "`" + std::string(name.text) + "`"; }

}  // namespace

Callee Sema::callee(const Expr& call) {
  const Expr& head = tree[call.operand];
  if (head.kind == ExprKind::kName) {
    VarId id = find_variable(head.name.text);
    if (!id.valid()) return named_callee(head);
    // The function's own name is its result inside; calling it would be recursion.
    if (variables_[id.index].decl == nullptr) {
      error(DiagnosticCode::kRecursiveCall, head.span, quoted(head.name) + " calls itself",
            "use a loop");
      return {};
    }
    // A variable may have a function's name; calls then still mean the function.
    bool instance = pou_of(resolve(id).type) != nullptr;
    if (!instance && standard_.contains(head.name.text)) return named_callee(head);
  }
  const Note& note = infer(call.operand);
  if (!note.type.valid()) return {};
  const PouInfo* block = pou_of(note.type);
  if (block == nullptr || block->decl->kind != PouKind::kFunctionBlock) {
    error(DiagnosticCode::kNotCallable, head.span,
          "`" + type_text(note.type) + "` cannot be called");
    return {};
  }
  Callee callee;
  callee.kind = Callee::Kind::kInstance;
  callee.pou = static_cast<uint32_t>(pou_by_type_.find(note.type)->second);
  return callee;
}

Callee Sema::named_callee(const Expr& head) {
  Callee callee;
  std::string_view name = head.name.text;
  bool declared = pou_names_.contains(name);
  if (!declared && !standard_.contains(name)) declared = use_library(name);
  if (declared) {
    uint32_t number = pou_names_.find(name)->second;
    if (pous[number].decl->kind == PouKind::kFunction) {
      callee.kind = Callee::Kind::kFunction;
      callee.pou = number;
      return callee;
    }
    bool block = pous[number].decl->kind == PouKind::kFunctionBlock;
    error(block ? DiagnosticCode::kNeedsInstance : DiagnosticCode::kNotCallable, head.span,
          quoted(head.name) + (block ? " is a function block" : " is a program"),
          block ? "declare an instance of it and call that" : "let a task run it");
    return callee;
  }
  if (auto found = standard_.find(name); found != standard_.end()) {
    callee.kind = Callee::Kind::kStandard;
    callee.row = found->second;
    return callee;
  }
  if (auto conversion = conversion_of_name(name)) {
    callee.kind = Callee::Kind::kConversion;
    callee.conversion = *conversion;
    return callee;
  }
  error(DiagnosticCode::kUnknownName, head.span, quoted(head.name) + " is not declared",
        name_suggestion(name, true));
  return callee;
}

Note Sema::infer_call(const Expr& expr) {
  Callee target = callee(expr);
  Note note;
  switch (target.kind) {
    case Callee::Kind::kError:
      return {};
    case Callee::Kind::kStandard:
      return infer_standard(expr, *target.row);
    case Callee::Kind::kConversion:
      return infer_conversion(expr, target.conversion);
    case Callee::Kind::kInstance:
      error(DiagnosticCode::kNoResult, expr.span, "a function block has no result",
            "call it in a statement of its own and read its outputs");
      return {};
    case Callee::Kind::kFunction:
      break;
  }
  const PouInfo& function = pous[target.pou];
  note.calls = true;
  if (!function.result.valid()) {
    error(DiagnosticCode::kNoResult, expr.span, quoted(function.decl->name) + " has no result",
          "call it in a statement of its own, or give it a result type");
    return {};
  }
  note.type = resolve(function.result).type;
  return note;
}

Note Sema::unify_arguments(const std::vector<ExprId>& args, uint32_t first) {
  Note note = infer(args[first]);
  for (uint32_t i = first + 1; i < args.size(); ++i) {
    note = unify(note, infer(args[i]), tree[args[i]].span);
    if (!note.type.valid()) return {};
  }
  note.variable = {};
  note.constant = false;
  note.progress = Progress::kNew;
  return note;
}

Note Sema::infer_conversion(const Expr& expr, const Conversion& conversion) {
  if (expr.args.count != 1 || !tree.args[expr.args.first].value.valid()) {
    error(DiagnosticCode::kWrongArgumentCount, expr.span, "a conversion takes one argument");
    return {};
  }
  Note note = infer(tree.args[expr.args.first].value);
  if (!note.type.valid()) return {};
  bool convertible = program.types.is_scalar(note.type) || is_string(program.types, note.type);
  if (!convertible) {
    error(DiagnosticCode::kWrongArgument, expr.span,
          "`" + type_text(note.type) + "` cannot be converted");
    return {};
  }
  Traits source = traits_of(program.types, note.type);
  note.variable = {};
  note.constant = false;
  note.flex = Flex::kNone;
  uint32_t capacity = is_string(program.types, note.type) ? program.types[note.type].capacity
                                                          : kDefaultStringCapacity;
  note.type = conversion.to == ir::Kind::kString    ? program.types.string(capacity)
              : conversion.to == ir::Kind::kWstring ? program.types.wstring(capacity)
                                                    : program.types.elementary(conversion.to);
  note.can_trap = note.can_trap || (source.real && !traits_of(program.types, note.type).real);
  return note;
}

}  // namespace frontend
