// Typed names of overloaded standard functions (IEC 61131-3 table 21): ADD_INT, MAX_REAL, GT_DINT.
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

using stdlib::FunctionRule;

// Is there a function of that rule for operands of these traits only?
bool has_typed_name(const stdlib::FunctionRow& row, const Traits& traits) {
  switch (row.rule) {
    case FunctionRule::kReal:
      return traits.real;
    case FunctionRule::kNumberSame:
      return traits.number();
    case FunctionRule::kArithmetic:
      return row.id == stdlib::FunctionId::kMod    ? traits.integer
             : row.id == stdlib::FunctionId::kExpt ? traits.real
                                                   : traits.number();
    case FunctionRule::kBitwise:
    case FunctionRule::kNot:
      return traits.bits || traits.boolean;
    case FunctionRule::kShift:
      return traits.bits;
    case FunctionRule::kMove:
    case FunctionRule::kSelect:
    case FunctionRule::kExtreme:
    case FunctionRule::kMux:
    case FunctionRule::kCompare:
      return true;
    case FunctionRule::kTrunc:
    case FunctionRule::kString:
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
      break;  // for operands of one type, or the name has it already
  }
  return false;
}

// The arguments that have the type of the name, the others being selectors and counts.
struct TypedArguments {
  size_t first = 0;
  size_t end = 0;
};

TypedArguments typed_arguments(FunctionRule rule, size_t count) {
  bool selector = rule == FunctionRule::kSelect || rule == FunctionRule::kMux;
  return {selector ? size_t{1} : size_t{0}, rule == FunctionRule::kShift ? size_t{1} : count};
}

}  // namespace

// WLEN, WCONCAT and their kin: the string functions on WSTRING, as CODESYS and TwinCAT name them.
static Callee wide_callee(const Sema& sema, std::string_view name) {
  Callee callee;
  const bool wide = sema.options.dialect != Dialect::kIec && name.size() > 1 &&
                    ir::same_name(name.substr(0, 1), "W");
  if (!wide) return callee;
  const auto row = sema.library.functions.find(name.substr(1));
  if (row == sema.library.functions.end()) return callee;
  const FunctionRule rule = row->second->rule;
  if (rule != FunctionRule::kString && rule != FunctionRule::kStringNumber) return callee;
  callee.kind = Callee::Kind::kStandard;
  callee.row = row->second;
  callee.wide = true;
  return callee;
}

Callee Calls::typed_callee(std::string_view name) const {
  Callee callee = wide_callee(sema_, name);
  if (callee.wide) return callee;
  size_t cut = name.rfind('_');
  if (cut == std::string_view::npos) return callee;
  auto row = sema_.library.functions.find(name.substr(0, cut));
  auto kind = kind_of_name(name.substr(cut + 1));
  if (row == sema_.library.functions.end() || !kind) return callee;
  ir::TypeId type = sema_.program.types.elementary(*kind);
  if (!sema_.program.types.is_scalar(type)) return callee;
  if (!has_typed_name(*row->second, traits_of(sema_.program.types, type))) return callee;
  callee.kind = Callee::Kind::kStandard;
  callee.row = row->second;
  callee.typed = type;
  return callee;
}

bool Calls::takes_typed(const Callee& callee, const std::vector<ExprId>& args) {
  const uint32_t texts = callee.wide ? string_arguments(*callee.row, args.size()) : 0;
  for (uint32_t i = 0; i < texts; ++i) {
    const ir::TypeId type = infer(args[i]).type;
    if (sema_.program.types[type].kind == ir::Kind::kWstring) continue;
    error(DiagnosticCode::kWrongArgument, sema_.tree[args[i]].span,
          "argument " + std::to_string(i + 1) + " is `" + sema_.report.type_text(type) +
              "`, not `WSTRING`",
          "call " + std::string(callee.row->name) + ", which takes both");
    return false;
  }
  if (!callee.typed.valid()) return true;
  Note wanted;
  wanted.type = callee.typed;
  TypedArguments typed = typed_arguments(callee.row->rule, args.size());
  for (size_t i = typed.first; i < typed.end && i < args.size(); ++i) {
    const Note& argument = infer(args[i]);
    Note common = ask<OperatorTypes>().unify(wanted, argument, sema_.tree[args[i]].span);
    if (!common.type.valid()) return false;
    if (common.type == callee.typed) continue;
    error(DiagnosticCode::kWrongArgument, sema_.tree[args[i]].span,
          "argument " + std::to_string(i + 1) + " is `" + sema_.report.type_text(argument.type) +
              "`, not `" + sema_.report.type_text(callee.typed) + "`",
          "convert it, or call " + std::string(callee.row->name) + ", which takes any type");
    return false;
  }
  return true;
}

}  // namespace frontend
