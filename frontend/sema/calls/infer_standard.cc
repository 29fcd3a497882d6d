// Standard functions: the rules of stdlib/registry.h, one case each.
#include <algorithm>

#include "base/limits.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"
#include "frontend/sema/phase.h"

namespace frontend {

using stdlib::FunctionRule;

namespace {

// In a diagram: what arrives at a box, from the rail too, which is TRUE at the place of the box.
bool is_power(const Sema& sema, ExprId id) {
  const Expr& expr = sema.tree[id];
  if (expr.kind != ExprKind::kLiteral) return expr.kind == ExprKind::kResult;
  const uint32_t file = sema.sources.file_of(expr.span.begin);
  if (file == sema.sources.file_count()) return false;
  const uint32_t at = expr.span.begin.offset - sema.sources.begin(file).offset;
  const std::string_view begins = sema.sources.text(file).substr(at, 1);
  return begins == "[" || begins == "_";
}

// Power at an operand of a box for numbers is meant for EN.
bool takes_power(const Phase& phase, const Expr& expr, const stdlib::FunctionRow& row,
                 const std::vector<ExprId>& args) {
  const bool numbers = row.rule == FunctionRule::kCompare ||
                       row.rule == FunctionRule::kArithmetic || row.rule == FunctionRule::kExtreme;
  if (!numbers || args.size() < 2 || !args[0].valid() || !args[1].valid()) return false;
  const bool power = is_power(phase.sema(), args[0]) &&
                     traits_of(phase.sema().program.types, phase.infer(args[0]).type).boolean;
  if (!power || !traits_of(phase.sema().program.types, phase.infer(args[1]).type).number())
    return false;
  phase.error(DiagnosticCode::kOperandsDiffer, expr.span,
              "power, which is `BOOL`, arrives at an operand of " + std::string(row.name),
              "let it arrive at EN: " + std::string(row.name) + "(EN:=_, ...)");
  return true;
}

}  // namespace

BinaryOp standard_operator(stdlib::FunctionId id) {
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

Note StandardCalls::infer_standard(const Expr& expr, const Callee& callee) {
  const stdlib::FunctionRow& row = *callee.row;
  std::vector<ExprId> args = standard_arguments(expr, row);
  if (args.empty() && ask<Calls>().plain_arguments(expr, nullptr).size() + row.fewest != 0)
    return {};
  Note all;
  all.known = row.rule == FunctionRule::kClock ? Known::kNo : Known::kByCall;
  for (ExprId arg : args) {
    if (!arg.valid()) continue;  // an output that is not connected
    const Note& note = infer(arg);
    if (!note.type.valid()) return {};
    all.calls = all.calls || note.calls;
    all.can_trap = all.can_trap || note.can_trap;
    const bool address = sema_.program.types.is_reference(note.type);  // known at run time only
    all.known = address ? Known::kNo : std::min(all.known, note.known);
  }
  if (!ask<Calls>().takes_typed(callee, args) || takes_power(*this, expr, row, args)) return {};
  Note note = infer_rule(expr, row, args);
  if (callee.typed.valid() && note.type.valid() && row.rule != FunctionRule::kCompare) {
    note.type = callee.typed;
    note.flex = Flex::kNone;
  }
  note.width = standard_width(*this, row, args, note, callee.typed.valid());
  note.known = all.known;
  note.bit_size = 0;
  note.calls = all.calls;
  note.can_trap = note.can_trap || all.can_trap;
  note.constant = false;
  note.variable = {};
  note.progress = Progress::kNew;
  ask<Calls>().mark_enabled(expr, note);
  return note;
}

Note StandardCalls::infer_rule(const Expr& expr, const stdlib::FunctionRow& row,
                               const std::vector<ExprId>& args) {
  auto argument = [&](uint32_t i) -> const Note& { return infer(args[i]); };
  auto elementary = [&](ir::Kind kind) {
    Note note;
    note.type = sema_.program.types.elementary(kind);
    return note;
  };
  auto refuse = [&](const Note& note) {
    error(DiagnosticCode::kWrongArgument, expr.span,
          std::string(row.name) + " is not defined for `" + sema_.report.type_text(note.type) + "`",
          "it takes " + std::string(row.signature));
    return Note();
  };
  switch (row.rule) {
    case FunctionRule::kClock:
      return elementary(row.id == stdlib::FunctionId::kTime ? ir::Kind::kTime : ir::Kind::kLtime);
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
    case FunctionRule::kMoment:
      return infer_by_signature(row, args);
    case FunctionRule::kSplit:
      error(DiagnosticCode::kNoResult, expr.span, std::string(row.name) + " has no result",
            "call it in a statement of its own");
      return {};
    case FunctionRule::kWeekday: {
      ir::Kind kind = sema_.program.types.root_kind(argument(0).type);
      bool clock = kind == ir::Kind::kTod || kind == ir::Kind::kLtod;
      if (!traits_of(sema_.program.types, argument(0).type).date || clock)
        return refuse(argument(0));
      return elementary(ir::Kind::kInt);
    }
    case FunctionRule::kByteOrder: {
      Note note = argument(0);
      note.type = without_range(sema_.program.types, note.type);
      note.flex = Flex::kNone;
      return sema_.program.types.is_scalar(note.type) ? note : refuse(note);
    }
    case FunctionRule::kValid: {
      Traits traits = traits_of(sema_.program.types, argument(0).type);
      bool real = row.id == stdlib::FunctionId::kIsValid;
      if (real ? !traits.real : !traits.bits) return refuse(argument(0));
      return elementary(ir::Kind::kBool);
    }
    case FunctionRule::kMove:
      return argument(0);
    case FunctionRule::kNumberSame: {
      Note note = argument(0);
      Traits traits = traits_of(sema_.program.types, note.type);
      note.type = without_range(sema_.program.types, note.type);
      return traits.number() || traits.duration || traits.bits ? note : refuse(note);
    }
    case FunctionRule::kReal: {
      Note note = ask<OperatorTypes>().unify_arguments(args, 0);
      Traits traits = traits_of(sema_.program.types, note.type);
      if (traits.real) return note;
      if (!traits.integer && !traits.bits) return note.type.valid() ? refuse(note) : note;
      if (sema_.options.dialect == Dialect::kIec && note.flex == Flex::kNone) return refuse(note);
      Note real = elementary(ir::Kind::kLreal);
      real.flex = Flex::kReal;
      return real;
    }
    case FunctionRule::kTrunc: {
      if (!traits_of(sema_.program.types, argument(0).type).real) return refuse(argument(0));
      Note note = elementary(ir::Kind::kDint);
      note.can_trap = true;
      return note;
    }
    case FunctionRule::kArithmetic:
    case FunctionRule::kBitwise: {
      const BinaryOp op = standard_operator(row.id);
      if (op == BinaryOp::kDiv || op == BinaryOp::kMod) check_wrapped(*this, args[0], "divided");
      Note note = argument(0);
      for (uint32_t i = 1; i < args.size() && note.type.valid(); ++i) {
        note = row.rule == FunctionRule::kArithmetic
                   ? ask<OperatorTypes>().infer_arithmetic(standard_operator(row.id), note,
                                                           argument(i), expr.span)
                   : ask<OperatorTypes>().infer_bitwise(standard_operator(row.id), note,
                                                        argument(i), expr.span);
      }
      const bool divides = op == BinaryOp::kDiv || op == BinaryOp::kMod;
      if (divides && note.type.valid() && argument(1).constant && !argument(0).constant) {
        check_divisor(*this, args[1], !traits_of(sema_.program.types, note.type).real);
      }
      for (const ExprId arg : args)
        note = widened_by(*this, note, arg, row.rule == FunctionRule::kArithmetic);
      return note;
    }
    case FunctionRule::kNot: {
      Note note = argument(0);
      Traits traits = traits_of(sema_.program.types, note.type);
      note.type = without_range(sema_.program.types, note.type);
      return traits.boolean || traits.bits || traits.integer ? note : refuse(note);
    }
    case FunctionRule::kShift: {
      Note note = argument(0);
      Traits traits = traits_of(sema_.program.types, note.type);
      Traits count = traits_of(sema_.program.types, argument(1).type);
      note.type = without_range(sema_.program.types, note.type);
      if (!traits.bits && !traits.integer) return refuse(note);
      if (row.id == stdlib::FunctionId::kShr)
        check_wrapped(*this, cut_below(args[0]), "shifted right");
      return count.integer || count.bits ? note : refuse(argument(1));
    }
    case FunctionRule::kSelect:
    case FunctionRule::kMux: {
      Note note = ask<OperatorTypes>().unify_arguments(args, 1);
      for (size_t i = 1; i < args.size(); ++i) note = widened_by(*this, note, args[i], false);
      return note;
    }
    case FunctionRule::kExtreme: {
      Note note = ask<OperatorTypes>().unify_arguments(args, 0);
      for (const ExprId arg : args) note = widened_by(*this, note, arg, false);
      bool ordered =
          sema_.program.types.is_scalar(note.type) || is_string(sema_.program.types, note.type);
      return !note.type.valid() || ordered ? note : refuse(note);
    }
    case FunctionRule::kCompare: {
      for (const ExprId arg : args) check_wrapped(*this, arg, "compared");
      Note common = ask<OperatorTypes>().unify_arguments(args, 0);
      return ask<OperatorTypes>().infer_comparison(standard_operator(row.id), common, common,
                                                   expr.span);
    }
    case FunctionRule::kString:
      return infer_string_function(args, row);
    case FunctionRule::kStringNumber:
      if (!infer_string_function(args, row).type.valid()) return {};
      return elementary(ir::Kind::kInt);
  }
  return {};
}

// INT_TO_WORD(a * 3), which makes bits of a number, is what was cut in it.
ExprId StandardCalls::cut_below(ExprId id) {
  while (infer(id).width == Width::kCopies) id = ask<Calls>().conversion_argument(sema_.tree[id]);
  return id;
}

// The leading arguments are strings of one kind. The result has room for whatever
// can come out, so nothing is cut before it is assigned.
Note StandardCalls::infer_string_function(const std::vector<ExprId>& args,
                                          const stdlib::FunctionRow& row) {
  uint32_t strings = string_arguments(row, static_cast<uint32_t>(args.size()));
  uint64_t room = 0;
  bool wide = false;
  for (uint32_t i = 0; i < args.size(); ++i) {
    const Note& note = infer(args[i]);
    Traits traits = traits_of(sema_.program.types, note.type);
    bool string = is_string(sema_.program.types, note.type);
    bool fits = i < strings ? string : traits.integer || traits.bits;
    bool is_wide = string && sema_.program.types[note.type].kind == ir::Kind::kWstring;
    if (!fits || (string && i > 0 && i < strings && is_wide != wide)) {
      error(DiagnosticCode::kWrongArgument, sema_.tree[args[i]].span,
            "argument " + std::to_string(i + 1) + " of " + std::string(row.name) + " is `" +
                sema_.report.type_text(note.type) + "`",
            "it takes " + std::string(row.signature));
      return {};
    }
    if (i < strings) {
      room += sema_.program.types[note.type].capacity;
      wide = is_wide;
    }
  }
  uint32_t capacity = static_cast<uint32_t>(std::min<uint64_t>(room, base::kMaxStringCapacity));
  Note note;
  note.type = wide ? sema_.program.types.wstring(capacity) : sema_.program.types.string(capacity);
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
