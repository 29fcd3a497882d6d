// Calls: what is called, and what it gives back.
#include <algorithm>

#include "base/limits.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

using stdlib::FunctionRule;

BinaryOp operator_of(stdlib::FunctionId id) {
  switch (id) {
    case stdlib::FunctionId::kAdd:
      return BinaryOp::kAdd;
    case stdlib::FunctionId::kSub:
      return BinaryOp::kSub;
    case stdlib::FunctionId::kMul:
      return BinaryOp::kMul;
    case stdlib::FunctionId::kDiv:
      return BinaryOp::kDiv;
    case stdlib::FunctionId::kMod:
      return BinaryOp::kMod;
    case stdlib::FunctionId::kExpt:
      return BinaryOp::kPower;
    case stdlib::FunctionId::kAnd:
      return BinaryOp::kAnd;
    case stdlib::FunctionId::kOr:
      return BinaryOp::kOr;
    case stdlib::FunctionId::kXor:
      return BinaryOp::kXor;
    case stdlib::FunctionId::kGt:
      return BinaryOp::kGt;
    case stdlib::FunctionId::kGe:
      return BinaryOp::kGe;
    case stdlib::FunctionId::kLt:
      return BinaryOp::kLt;
    case stdlib::FunctionId::kLe:
      return BinaryOp::kLe;
    case stdlib::FunctionId::kNe:
      return BinaryOp::kNe;
    default:
      return BinaryOp::kEq;
  }
}

std::string quoted(const Name& name) { return "`" + std::string(name.text) + "`"; }

}  // namespace

BinaryOp standard_operator(stdlib::FunctionId id) { return operator_of(id); }

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

Note Sema::infer_standard(const Expr& expr, const stdlib::FunctionRow& row) {
  std::vector<ExprId> args = standard_arguments(expr, row);
  if (args.empty() && expr.args.count + row.fewest != 0) return {};
  Note all;
  for (ExprId arg : args) {
    const Note& note = infer(arg);
    if (!note.type.valid()) return {};
    all.calls = all.calls || note.calls;
    all.can_trap = all.can_trap || note.can_trap;
  }
  Note note = infer_rule(expr, row, args);
  note.calls = all.calls;
  note.can_trap = note.can_trap || all.can_trap;
  note.constant = false;
  note.variable = {};
  note.progress = Progress::kNew;
  return note;
}

Note Sema::infer_rule(const Expr& expr, const stdlib::FunctionRow& row,
                      const std::vector<ExprId>& args) {
  auto argument = [&](uint32_t i) -> const Note& { return infer(args[i]); };
  auto elementary = [&](ir::Kind kind) {
    Note note;
    note.type = program.types.elementary(kind);
    return note;
  };
  auto refuse = [&](const Note& note) {
    error(DiagnosticCode::kWrongArgument, expr.span,
          std::string(row.name) + " is not defined for `" + type_text(note.type) + "`",
          "it takes " + std::string(row.signature));
    return Note();
  };
  switch (row.rule) {
    case FunctionRule::kClock:
      return elementary(row.id == stdlib::FunctionId::kTime ? ir::Kind::kTime : ir::Kind::kLtime);
    case FunctionRule::kMove:
      return argument(0);
    case FunctionRule::kNumberSame: {
      Note note = argument(0);
      Traits traits = traits_of(program.types, note.type);
      note.type = without_range(program.types, note.type);
      return traits.number() || traits.duration || traits.bits ? note : refuse(note);
    }
    case FunctionRule::kReal: {
      Note note = unify_arguments(args, 0);
      Traits traits = traits_of(program.types, note.type);
      if (traits.real) return note;
      if (!traits.integer && !traits.bits) return note.type.valid() ? refuse(note) : note;
      if (options.dialect == Dialect::kIec && note.flex == Flex::kNone) return refuse(note);
      Note real = elementary(ir::Kind::kLreal);
      real.flex = Flex::kReal;
      return real;
    }
    case FunctionRule::kTrunc: {
      if (!traits_of(program.types, argument(0).type).real) return refuse(argument(0));
      Note note = elementary(ir::Kind::kDint);
      note.can_trap = true;
      return note;
    }
    case FunctionRule::kArithmetic:
    case FunctionRule::kBitwise: {
      Note note = argument(0);
      for (uint32_t i = 1; i < args.size() && note.type.valid(); ++i) {
        note = row.rule == FunctionRule::kArithmetic
                   ? infer_arithmetic(operator_of(row.id), note, argument(i), expr.span)
                   : infer_bitwise(operator_of(row.id), note, argument(i), expr.span);
      }
      return note;
    }
    case FunctionRule::kNot: {
      Note note = argument(0);
      Traits traits = traits_of(program.types, note.type);
      note.type = without_range(program.types, note.type);
      return traits.boolean || traits.bits || traits.integer ? note : refuse(note);
    }
    case FunctionRule::kShift: {
      Note note = argument(0);
      Traits traits = traits_of(program.types, note.type);
      Traits count = traits_of(program.types, argument(1).type);
      note.type = without_range(program.types, note.type);
      if (!traits.bits && !traits.integer) return refuse(note);
      return count.integer || count.bits ? note : refuse(argument(1));
    }
    case FunctionRule::kSelect:
    case FunctionRule::kMux:
      return unify_arguments(args, 1);
    case FunctionRule::kExtreme: {
      Note note = unify_arguments(args, 0);
      bool ordered = program.types.is_scalar(note.type) || is_string(program.types, note.type);
      return !note.type.valid() || ordered ? note : refuse(note);
    }
    case FunctionRule::kCompare: {
      for (uint32_t i = 0; i + 1 < args.size(); ++i) {
        Note note = infer_comparison(operator_of(row.id), argument(i), argument(i + 1), expr.span);
        if (!note.type.valid()) return note;
      }
      return elementary(ir::Kind::kBool);
    }
    case FunctionRule::kString:
      return infer_string_function(args, row);
    case FunctionRule::kStringNumber:
      if (!infer_string_function(args, row).type.valid()) return {};
      return elementary(ir::Kind::kInt);
  }
  return {};
}

// The leading arguments are strings of one kind. The result has room for whatever
// can come out, so nothing is cut before it is assigned.
Note Sema::infer_string_function(const std::vector<ExprId>& args, const stdlib::FunctionRow& row) {
  uint32_t strings = string_arguments(row, static_cast<uint32_t>(args.size()));
  uint64_t room = 0;
  bool wide = false;
  for (uint32_t i = 0; i < args.size(); ++i) {
    const Note& note = infer(args[i]);
    Traits traits = traits_of(program.types, note.type);
    bool string = is_string(program.types, note.type);
    bool fits = i < strings ? string : traits.integer || traits.bits;
    bool is_wide = string && program.types[note.type].kind == ir::Kind::kWstring;
    if (!fits || (string && i > 0 && i < strings && is_wide != wide)) {
      error(DiagnosticCode::kWrongArgument, tree[args[i]].span,
            "argument " + std::to_string(i + 1) + " of " + std::string(row.name) + " is `" +
                type_text(note.type) + "`",
            "it takes " + std::string(row.signature));
      return {};
    }
    if (i < strings) {
      room += program.types[note.type].capacity;
      wide = is_wide;
    }
  }
  uint32_t capacity = static_cast<uint32_t>(std::min<uint64_t>(room, base::kMaxStringCapacity));
  Note note;
  note.type = wide ? program.types.wstring(capacity) : program.types.string(capacity);
  return note;
}

uint32_t string_arguments(const stdlib::FunctionRow& row, uint32_t count) {
  switch (row.id) {
    case stdlib::FunctionId::kConcat:
      return count;
    case stdlib::FunctionId::kInsert:
    case stdlib::FunctionId::kReplace:
    case stdlib::FunctionId::kFind:
      return 2;
    default:
      return 1;
  }
}

}  // namespace frontend
