#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/constants/constants.h"

#include <algorithm>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/value_range.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {

namespace {

// How many traps of one operand are kept; an operand with more is warned of as a whole, so that
// long chains cost no square.
constexpr size_t kMostTraps = 64;

// As written, but for blanks and case; "" for what stands in no source.
std::string text_of(const Sema& sema, ExprId id) {
  const base::SourceSpan span = sema.tree[id].span;
  const uint32_t file = sema.sources.file_of(span.begin);
  if (file == sema.sources.file_count()) return {};
  std::string out(sema.sources.text(file).substr(
      span.begin.offset - sema.sources.begin(file).offset, span.end.offset - span.begin.offset));
  std::erase_if(out, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
  return ir::fold_name(out);
}

// Texts of the parts of `id` that can trap and are evaluated whenever it is. False where not all
// of them are found.
bool find_traps(const Phase& phase, ExprId id, std::vector<std::string>& out) {
  for (;;) {
    const Expr& expr = phase.sema().tree[id];
    const Note& note = phase.infer(id);
    if (!note.can_trap) return true;
    if (note.calls || out.size() == kMostTraps) return false;
    switch (expr.kind) {
      case ExprKind::kDeref:
      case ExprKind::kMember:
      case ExprKind::kIndex:
        out.push_back(text_of(phase.sema(), id));
        return !out.back().empty();
      case ExprKind::kUnary:
        break;
      case ExprKind::kBinary: {
        const bool lazy = expr.binary == BinaryOp::kAndThen || expr.binary == BinaryOp::kOrElse;
        const bool divides = expr.binary == BinaryOp::kDiv || expr.binary == BinaryOp::kMod;
        if (divides || (!lazy && !find_traps(phase, expr.right, out))) return false;
        if (lazy && phase.infer(expr.right).can_trap) return false;
        break;
      }
      default:
        return false;
    }
    id = expr.operand;  // a loop: chains of operators are long on this side
  }
}

// A variable or a part of one, whose way has no calls.
bool is_place(const Phase& phase, ExprId id) {
  const Expr& expr = phase.sema().tree[id];
  const bool part = expr.kind == ExprKind::kMember || expr.kind == ExprKind::kIndex ||
                    expr.kind == ExprKind::kDeref || expr.kind == ExprKind::kName;
  return part && !phase.infer(id).calls;
}

}  // namespace

void check_right_operand(const Phase& phase, const Expr& expr) {
  std::vector<std::string> traps;
  std::vector<std::string> before;
  const bool all_known = find_traps(phase, expr.right, traps);
  find_traps(phase, expr.operand, before);
  const bool done = std::all_of(traps.begin(), traps.end(), [&](const std::string& trap) {
    return std::find(before.begin(), before.end(), trap) != before.end();
  });
  if (all_known && done) return;
  const bool drawn = expr.op == expr.span.begin;  // between contacts in a row
  const bool conjunction = expr.binary == BinaryOp::kAnd;
  phase.warning(DiagnosticCode::kRightOperandTraps, phase.sema().tree[expr.right].span,
                drawn ? std::string("this contact is evaluated without power, too, and can trap")
                      : "the right operand of " + std::string(operator_text(expr.binary)) +
                            " is evaluated in any case and can trap",
                drawn              ? "compute it in a box with EN, or jump over the rung"
                : expr.instruction ? "jump over it with JMPCN"
                : conjunction      ? "use AND_THEN"
                                   : "use OR_ELSE");
}

void check_divisor(const Phase& phase, ExprId divisor, bool whole) {
  const auto value = phase.ask<Constants>().fold(divisor, {});
  if (!value || value->integer != 0 || value->real != 0) return;
  // A constant that has a name may be another one some day, and be asked before.
  if (whole && phase.sema().tree[divisor].kind == ExprKind::kLiteral) {
    phase.error(DiagnosticCode::kConstantDivision, phase.sema().tree[divisor].span,
                "the divisor is 0", "divide by something else; this would trap in every scan");
    return;
  }
  phase.warning(DiagnosticCode::kZeroDivisor, phase.sema().tree[divisor].span,
                "the divisor is always 0", "divide only where it is not 0: IF n <> 0 THEN ...");
}

// Zero is exact, and comparing with it is how divisors are tested.
void check_real_equality(const Phase& phase, const Expr& expr) {
  if (expr.binary != BinaryOp::kEq && expr.binary != BinaryOp::kNe) return;
  bool real = false;
  bool constant = true;
  for (ExprId side : {expr.operand, expr.right}) {
    const Note& note = phase.infer(side);
    constant = constant && note.constant;
    const bool fixed = note.flex == Flex::kNone;
    real = real || (traits_of(phase.sema().program.types, note.type).real && fixed);
    if (!note.constant || !note.type.valid()) continue;
    const Expr& literal = phase.sema().tree[side];
    if (literal.kind != ExprKind::kLiteral) continue;
    const Literal& value = phase.sema().tree.literals[literal.number];
    if (value.integer == 0 && value.real == 0) return;
  }
  if (!real || constant) return;
  if (is_place(phase, expr.operand) &&
      text_of(phase.sema(), expr.operand) == text_of(phase.sema(), expr.right)) {
    return;  // NaN alone differs from itself
  }
  phase.warning(DiagnosticCode::kRealEquality, expr.span,
                "reals are compared with " + std::string(operator_text(expr.binary)),
                "compare the distance: ABS(a - b) < limit");
}

void warn_of_decided(const Phase& phase, BinaryOp op, ExprId left, ExprId right, ir::TypeId type) {
  const bool behind = phase.infer(right).constant;
  const ExprId literal = behind ? right : left;
  const auto value = phase.ask<Constants>().fold(literal, {});
  if (!value) return;
  const Limits limits = limits_of(phase.sema().program.types.scalar(type));
  const bool less = (value->integer > limits.high) == behind;  // is left less than right?
  const bool holds = op == BinaryOp::kNe ||
                     (op != BinaryOp::kEq && less == (op == BinaryOp::kLt || op == BinaryOp::kLe));
  const std::string name = phase.sema().report.type_text(type);
  phase.warning(DiagnosticCode::kConditionConstant, phase.sema().tree[literal].span,
                "this comparison is always " + std::string(holds ? "TRUE" : "FALSE") + ": `" +
                    name + "` holds " + wide_text(limits.low) + ".." + wide_text(limits.high),
                "compare with a value in it, or take a longer type");
}

bool is_wider(const ir::TypeTable& types, ir::TypeId target, ir::TypeId own) {
  const Traits traits = traits_of(types, target);
  if (!traits.number() && !traits.bits) return false;
  return traits.real || ir::scalar_size(types.scalar(target)) > ir::scalar_size(types.scalar(own));
}

void check_wrapped(const Phase& phase, ExprId operand, std::string_view used) {
  const Note& note = phase.infer(operand);
  if (note.width != Width::kWraps || note.constant) return;
  const Expr& expr = phase.sema().tree[operand];
  if (expr.kind == ExprKind::kCall) {
    using stdlib::FunctionRule;
    const Callee callee = phase.ask<Calls>().callee(expr);
    if (callee.kind != Callee::Kind::kStandard) return;
    const FunctionRule rule = callee.row->rule;
    if (rule != FunctionRule::kArithmetic && rule != FunctionRule::kBitwise) {
      const bool chooses = rule == FunctionRule::kSelect || rule == FunctionRule::kMux;
      const auto args = phase.ask<StandardCalls>().standard_arguments(expr, *callee.row);
      for (size_t i = chooses ? 1 : 0; i < args.size(); ++i) check_wrapped(phase, args[i], used);
      return;
    }
  }
  if (!may_leave_type(phase, operand)) return;
  const std::string type = phase.sema().report.type_text(note.type);
  const std::string to_longer = is_small(phase.sema(), note) ? "TO_DINT(a)" : "TO_LINT(a)";
  phase.warning(
      DiagnosticCode::kCutBeforeUse, phase.sema().tree[operand].span,
      "the result is cut to `" + type + "` before it is " + std::string(used),
      used == "divided"
          ? "convert an operand: (" + to_longer + " + b) / c; where that has to be `" + type +
                "` again, the whole, too: TO_" + type + "((" + to_longer + " + b) / c)"
          : "convert an operand, so that the operator has the width that is needed: " + to_longer);
}

}  // namespace frontend
