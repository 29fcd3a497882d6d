// Intermediate results below 32 bits in dialects codesys and twincat (docs/LANGUAGE.md): they are
// computed as DINT. Where only their low bits are wanted, because they are stored in a small
// variable, `+`, `-`, `*` and the bitwise operators give the same bits in its type, so the code is
// that of an operation in that type.
#include "frontend/sema/expressions/width.h"
#include "frontend/lower/conversions.h"
#include "frontend/lower/values.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/operators.h"

namespace frontend {
namespace {

bool divides(BinaryOp op) { return op == BinaryOp::kDiv || op == BinaryOp::kMod; }

// Has a quotient in `type` the bits that the one of DINTs has, in `machine`? The most negative
// number divided by -1 is itself in its own width.
bool divides_in(const Phase& phase, const Expr& expr, ir::TypeId type, ir::Scalar machine) {
  const ir::TypeTable& types = phase.sema().program.types;
  const auto own = [&](ExprId id) {
    const Note& note = phase.infer(id);
    const bool same = without_range(types, note.type) == without_range(types, type);
    return note.width != Width::kWide && (same || note.flex == Flex::kInteger);
  };
  const ir::Scalar there = types.scalar(type);
  const bool as_wide = ir::scalar_size(there) == ir::scalar_size(machine);
  return own(expr.operand) && own(expr.right) && (as_wide || !ir::is_signed(there));
}

}  // namespace

ir::ValueId Values::stored(ExprId sum, ir::TypeId target) {
  const Note& note = infer(sum);
  const base::SourceSpan span = tree_[sum].span;
  if (!ask<Conversions>().fits(note.type, target, span)) return code_.zero(target);
  const Traits to = traits_of(types(), target);
  const bool range = types()[target].kind == ir::Kind::kSubrange;
  const Expr& expr = tree_[sum];
  const bool quotient = range && expr.kind == ExprKind::kBinary && divides(expr.binary) &&
                        divides_in(*this, expr, note.type, scalar(target));
  if (quotient) return convert({emit(sum, note.type), note.type}, target, span);
  const bool low_bits = !range && (to.integer || to.bits) && ir::scalar_size(scalar(target)) < 4;
  const ir::TypeId dint = elementary(ir::Kind::kDint);
  const ir::TypeId type = low_bits ? target : dint;
  const ir::ValueId value = computed_in(sum, type);
  if (!range) return code_.machine_convert(value, scalar(type), scalar(target));
  const ir::Type& limits = types()[target];
  const Limits whole = limits_of(ir::Scalar::kI32);
  if (limits.low >= whole.low && limits.high <= whole.high) {  // before anything is cut off
    const ir::ValueId good = build_.check_range(ir::Scalar::kI32, value, limits.low, limits.high);
    return code_.machine_convert(good, ir::Scalar::kI32, scalar(target));
  }
  return code_.check_range(code_.machine_convert(value, ir::Scalar::kI32, scalar(target)), dint,
                           target);
}

// An operand, or a tree of operators, in `type`: nobody wants other bits than the low ones of that.
ir::ValueId Values::computed_in(ExprId id, ir::TypeId type) {
  const Note& note = infer(id);
  const Expr& expr = tree_[id];
  const ir::Scalar machine = scalar(type);
  if (is_known(note)) {
    const auto known = ask<Constants>().fold(
        id, elementary(ir::Kind::kDint), body_.evaluating ? Known::kInitially : Known::kConstant);
    set_line(expr.span);
    const Wide number = known ? wrap_to(machine, known->integer) : 0;
    return build_.constant(machine, static_cast<uint64_t>(number));
  }
  if (note.width != Width::kWide) {
    const Typed own = natural(id);
    return code_.machine_convert(own.value, scalar(own.type), machine);
  }
  set_line(expr.span);
  if (expr.kind == ExprKind::kUnary) {
    const ir::ValueId operand = computed_in(expr.operand, type);
    set_line({expr.op, expr.op});
    if (expr.unary == UnaryOp::kPlus) return operand;
    return build_.unary(expr.unary == UnaryOp::kNot ? ir::Op::kNot : ir::Op::kNeg, machine,
                        operand);
  }
  const ir::TypeId dint = elementary(ir::Kind::kDint);
  if (expr.kind != ExprKind::kBinary) {  // ADD(a, b)
    return code_.machine_convert(emit(id, dint), ir::Scalar::kI32, machine);
  }
  // Quotients need all bits of what is divided.
  const bool exact = divides(expr.binary) && machine != ir::Scalar::kI32;
  if (exact && !divides_in(*this, expr, note.type, machine)) {
    return code_.machine_convert(computed_in(id, dint), ir::Scalar::kI32, machine);
  }
  const ir::TypeId in = exact ? without_range(types(), note.type) : type;
  const ir::ValueId left = computed_in(expr.operand, in);
  const ir::ValueId right = computed_in(expr.right, in);
  if (operator_class(expr.binary) == OperatorClass::kLogical) set_line({expr.op, expr.op});
  return code_.machine_convert(code_.number_op(expr.binary, in, left, right), scalar(in), machine);
}

}  // namespace frontend
