// Binary operators.
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"
#include "ir/types/time_units.h"

namespace frontend {
namespace {

ir::Op machine_op(BinaryOp op) {
  switch (op) {
    case BinaryOp::kAdd:
      return ir::Op::kAdd;
    case BinaryOp::kSub:
      return ir::Op::kSub;
    case BinaryOp::kMul:
      return ir::Op::kMul;
    case BinaryOp::kDiv:
      return ir::Op::kDiv;
    case BinaryOp::kMod:
      return ir::Op::kMod;
    case BinaryOp::kAnd:
      return ir::Op::kAnd;
    case BinaryOp::kOr:
      return ir::Op::kOr;
    default:
      return ir::Op::kXor;
  }
}

bool is_time_like(const ir::TypeTable& types, ir::TypeId type) {
  Traits traits = traits_of(types, type);
  return traits.duration || traits.date;
}

}  // namespace

ir::ValueId ValueCode::number_op(BinaryOp op, ir::TypeId type, ir::ValueId a, ir::ValueId b) {
  return build_.binary(machine_op(op), scalar(type), a, b);
}

ir::ValueId Values::emit_binary(const Expr& expr, ir::TypeId own) {
  switch (operator_class(expr.binary)) {
    case OperatorClass::kComparison: {
      ir::ValueId result = emit_comparison(expr.binary, expr.operand, expr.right);
      return result;
    }
    case OperatorClass::kArithmetic:
      return emit_arithmetic(expr.binary, expr.operand, expr.right, own);
    case OperatorClass::kLogical:
      break;
  }
  if (expr.binary == BinaryOp::kAndThen || expr.binary == BinaryOp::kOrElse) {
    return emit_lazy(expr);
  }
  ir::ValueId left = value(expr.operand, own);
  ir::ValueId right = value(expr.right, own);
  set_line({expr.op, expr.op});
  return code_.number_op(expr.binary, own, left, right);
}

ir::ValueId Values::emit_lazy(const Expr& expr) {
  ir::TypeId boolean = elementary(ir::Kind::kBool);
  bool conjunction = expr.binary == BinaryOp::kAndThen;
  ir::ValueId left = value(expr.operand, boolean);
  ir::BlockId more = build_.new_block();
  ir::BlockId known = build_.new_block();
  ir::BlockId done = build_.new_block();
  ir::ValueId result = build_.add_param(done, ir::Scalar::kBool);
  body_.counting.decide(left, conjunction ? more : known, conjunction ? known : more, expr.op,
                        conjunction ? "left of AND_THEN" : "left of OR_ELSE");
  build_.start(known);
  ir::ValueId decided = build_.constant(ir::Scalar::kBool, conjunction ? 0 : 1);
  build_.jump(done, {decided});
  build_.start(more);
  ir::ValueId right = value(expr.right, boolean);
  build_.jump(done, {right});
  build_.start(done);
  return result;
}

ir::ValueId Values::emit_comparison(BinaryOp op, ExprId left, ExprId right) {
  Note common = ask<OperatorTypes>().unify(infer(left), infer(right), tree_[left].span);
  if (!common.type.valid()) return code_.zero(elementary(ir::Kind::kBool));
  if (is_string(types(), common.type)) return compare_strings(op, left, right);
  const ir::TypeId narrow = compared_type(*this, common.type, {left, right});
  common.type = compared_with_literals(*this, narrow, {left, right});
  if (common.type != narrow) warn_of_decided(*this, op, left, right, narrow);
  const ir::TypeId behind = ask<References>().compared_distance(left, right);
  const ir::TypeId distance =
      behind.valid() ? behind : ask<References>().compared_distance(right, left);
  if (distance.valid()) common.type = distance;
  ir::ValueId a = value(left, common.type);
  ir::ValueId b = value(right, common.type);
  const bool equality = op == BinaryOp::kEq || op == BinaryOp::kNe;
  const bool known = infer(left).constant || infer(right).constant;
  if (types().is_reference(common.type) && equality && known) {  // with NULL
    return build_.compare(op == BinaryOp::kEq ? ir::Op::kEq : ir::Op::kNe, ir::Scalar::kU64, a, b);
  }
  return code_.compare_scalars(op, common.type, a, b);
}

ir::ValueId ValueCode::compare_scalars(BinaryOp op, ir::TypeId type, ir::ValueId a, ir::ValueId b) {
  ir::Scalar machine = scalar(type);
  bool ordered = op != BinaryOp::kEq && op != BinaryOp::kNe;
  if (machine == ir::Scalar::kBool && ordered) {  // FALSE < TRUE
    a = build_.unary(ir::Op::kWrap, ir::Scalar::kU8, a);
    b = build_.unary(ir::Op::kWrap, ir::Scalar::kU8, b);
    machine = ir::Scalar::kU8;
  }
  if (types().is_reference(type)) {
    a = compared_place(build_, a, ordered);
    b = compared_place(build_, b, ordered);
  }
  switch (op) {
    case BinaryOp::kEq:
      return build_.compare(ir::Op::kEq, machine, a, b);
    case BinaryOp::kNe:
      return build_.compare(ir::Op::kNe, machine, a, b);
    case BinaryOp::kLt:
      return build_.compare(ir::Op::kLt, machine, a, b);
    case BinaryOp::kLe:
      return build_.compare(ir::Op::kLe, machine, a, b);
    case BinaryOp::kGt:
      return build_.compare(ir::Op::kLt, machine, b, a);
    default:
      return build_.compare(ir::Op::kLe, machine, b, a);
  }
}

ir::ValueId Values::compare_strings(BinaryOp op, ExprId left, ExprId right) {
  ir::Place a = place(left);
  return code_.compare_places(op, a, place(right));
}

ir::ValueId ValueCode::compare_places(BinaryOp op, const ir::Place& a, const ir::Place& b) {
  bool is_wide = wide(a.type);
  ir::ValueId order = native(is_wide ? stdlib::NativeId::kCompareW : stdlib::NativeId::kCompareS,
                             {string_value(a), string_value(b)});
  ir::ValueId none = build_.constant(ir::Scalar::kI32, 0);
  return compare_scalars(op, elementary(ir::Kind::kDint), order, none);
}

ir::ValueId Values::emit_arithmetic(BinaryOp op, ExprId left, ExprId right, ir::TypeId own) {
  const Note& a = infer(left);
  const Note& b = infer(right);
  if (types().is_reference(a.type) || types().is_reference(b.type)) {
    return ask<References>().emit_pointer_arithmetic(op, left, right, own);
  }
  if (op == BinaryOp::kPower) {
    Typed base = natural(left);
    return code_.power(base, natural(right), own);
  }
  if (is_time_like(types(), a.type) || is_time_like(types(), b.type)) {
    Typed first = natural(left);
    return code_.time_arithmetic(op, first, natural(right)).value;
  }
  ir::ValueId x = value(left, own);
  ir::ValueId y = value(right, own);
  return code_.number_op(op, own, x, y);
}

ir::ValueId ValueCode::power(Typed base, Typed exponent, ir::TypeId own) {
  // The base decides: whole ones have more bits than a REAL, and so may a whole exponent.
  const bool is_real = scalar(base.type) == ir::Scalar::kF32;
  const ir::Scalar machine = is_real ? ir::Scalar::kF32 : ir::Scalar::kF64;
  ir::ValueId x = machine_convert(base.value, scalar(base.type), machine);
  ir::ValueId y = machine_convert(exponent.value, scalar(exponent.type), ir::Scalar::kF64);
  const auto id = is_real ? stdlib::NativeId::kExptF32 : stdlib::NativeId::kExpt;
  ir::ValueId result = native(id, {x, y});
  return machine_convert(result, machine, scalar(own));
}

// All times and dates are nanoseconds in 64 bits; what may be combined was checked.
Typed ValueCode::time_arithmetic(BinaryOp op, Typed left, Typed right) {
  Traits a = traits_of(types(), left.type);
  Traits b = traits_of(types(), right.type);
  if (a.number()) return {scale_time(op, right.value, left), right.type};
  if (b.number()) return {scale_time(op, left.value, right), left.type};
  ir::ValueId result = build_.binary(machine_op(op), ir::Scalar::kI64, left.value, right.value);
  ir::TypeId type = left.type;
  bool any_long = is_long_time(types()[left.type].kind) || is_long_time(types()[right.type].kind);
  if (a.date && b.date) type = elementary(any_long ? ir::Kind::kLtime : ir::Kind::kTime);
  if (a.duration && any_long) type = elementary(ir::Kind::kLtime);
  if (is_time_of_day(types(), type)) result = floor_modulo(result, ir::kNsPerDay);
  return {result, type};
}

ir::ValueId ValueCode::scale_time(BinaryOp op, ir::ValueId time, Typed factor) {
  ir::Scalar machine = scalar(factor.type);
  if (!ir::is_float(machine)) {
    ir::ValueId number = machine_convert(factor.value, machine, ir::Scalar::kI64);
    return build_.binary(machine_op(op), ir::Scalar::kI64, time, number);
  }
  ir::ValueId number = machine_convert(factor.value, machine, ir::Scalar::kF64);
  ir::ValueId real = build_.unary(ir::Op::kToFloat, ir::Scalar::kF64, time);
  ir::ValueId scaled = build_.binary(machine_op(op), ir::Scalar::kF64, real, number);
  return build_.unary(ir::Op::kRound, ir::Scalar::kI64, scaled);
}

}  // namespace frontend
