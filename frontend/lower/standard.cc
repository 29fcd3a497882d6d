// Standard functions with scalar results.
#include <algorithm>

#include "frontend/lower/standard_code.h"
#include "frontend/lower/value_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {
namespace {

using stdlib::FunctionId;
using stdlib::FunctionRule;
using stdlib::NativeId;

NativeId real_native(FunctionId id, bool is_long) {
  switch (id) {
    case FunctionId::kLn:
      return is_long ? NativeId::kLn : NativeId::kLnF32;
    case FunctionId::kLog:
      return is_long ? NativeId::kLog : NativeId::kLogF32;
    case FunctionId::kExp:
      return is_long ? NativeId::kExp : NativeId::kExpF32;
    case FunctionId::kSin:
      return is_long ? NativeId::kSin : NativeId::kSinF32;
    case FunctionId::kCos:
      return is_long ? NativeId::kCos : NativeId::kCosF32;
    case FunctionId::kTan:
      return is_long ? NativeId::kTan : NativeId::kTanF32;
    case FunctionId::kAsin:
      return is_long ? NativeId::kAsin : NativeId::kAsinF32;
    case FunctionId::kAcos:
      return is_long ? NativeId::kAcos : NativeId::kAcosF32;
    case FunctionId::kAtan:
      return is_long ? NativeId::kAtan : NativeId::kAtanF32;
    default:
      return is_long ? NativeId::kAtan2 : NativeId::kAtan2F32;
  }
}

ir::Op shift_op(FunctionId id) {
  switch (id) {
    case FunctionId::kShl:
      return ir::Op::kShl;
    case FunctionId::kShr:
      return ir::Op::kShr;
    case FunctionId::kRol:
      return ir::Op::kRol;
    default:
      return ir::Op::kRor;
  }
}

}  // namespace

ir::ValueId StandardCode::emit_standard(const Expr& expr, const Callee& callee, ir::TypeId own) {
  const stdlib::FunctionRow& row = *callee.row;
  std::vector<ExprId> args = ask<StandardCalls>().standard_arguments(expr, row);
  switch (row.rule) {
    case FunctionRule::kClock:
      return build_.task_time();
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
      return time_function(args, row);
    case FunctionRule::kMoment:
      return moment(args, row);
    case FunctionRule::kWeekday:
      return day_of_week(args[0]);
    case FunctionRule::kByteOrder:
      return byte_order(args[0], row, own);
    case FunctionRule::kValid:
      return is_valid(args[0], row);
    case FunctionRule::kMove:
      return value(args[0], own);
    case FunctionRule::kNumberSame:
      return build_.unary(ir::Op::kAbs, scalar(own), value(args[0], own));
    case FunctionRule::kNot:
      return build_.unary(ir::Op::kNot, scalar(own), value(args[0], own));
    case FunctionRule::kTrunc: {
      Typed real = natural(args[0]);
      return code_.machine_convert(real.value, scalar(real.type), scalar(own), true);
    }
    case FunctionRule::kReal:
      return real_function(args, row, own);
    case FunctionRule::kArithmetic:
    case FunctionRule::kBitwise:
      return fold_operator(args, standard_operator(row.id), own);
    case FunctionRule::kShift:
      return shift(args, row, own);
    case FunctionRule::kSelect: {
      ir::ValueId condition = value(args[0], elementary(ir::Kind::kBool));
      ir::ValueId if_false = value(args[1], own);
      return build_.select(scalar(own), condition, if_false, value(args[2], own));
    }
    case FunctionRule::kExtreme:
      return extreme(args, row, own);
    case FunctionRule::kMux:
      return multiplex(args, own);
    case FunctionRule::kCompare:
      return compare_chain(
          args, standard_operator(row.id),
          callee.typed.valid() ? callee.typed : ask<OperatorTypes>().infer_common(args).type);
    case FunctionRule::kStringNumber:
      return string_number(args, row);
    case FunctionRule::kString:
    case FunctionRule::kSplit:
      break;
  }
  return code_.zero(own);
}

ir::ValueId StandardCode::real_function(const std::vector<ExprId>& args,
                                        const stdlib::FunctionRow& row, ir::TypeId own) {
  ir::Scalar machine = scalar(own);
  if (row.id == FunctionId::kSqrt) {
    return build_.unary(ir::Op::kSqrt, machine, value(args[0], own));
  }
  ir::ValueList operands;
  for (ExprId arg : args) operands.push_back(value(arg, own));
  return code_.native(real_native(row.id, machine == ir::Scalar::kF64), operands);
}

// ADD(a, b, c) is a + b + c.
ir::ValueId StandardCode::fold_operator(const std::vector<ExprId>& args, BinaryOp op,
                                        ir::TypeId own) {
  // As DINT, though no argument is one: computed_in() has asked for it.
  const bool wide = scalar(own) == ir::Scalar::kI32 && sema_.options.dialect != Dialect::kIec &&
                    std::all_of(args.begin(), args.end(), [&](ExprId arg) {
                      const Note& note = infer(arg);
                      return is_small(sema_, note) || note.flex == Flex::kInteger;
                    });
  const auto operand = [&](ExprId arg) {
    return wide ? ask<Values>().computed_in(arg, own) : value(arg, own);
  };
  if (args.size() == 2 && !wide && op != BinaryOp::kAnd && op != BinaryOp::kOr &&
      op != BinaryOp::kXor) {
    return ask<Values>().emit_arithmetic(op, args[0], args[1], own);
  }
  Traits traits = traits_of(types(), own);
  if (traits.duration || traits.date) {
    Typed sum = natural(args[0]);
    for (size_t i = 1; i < args.size(); ++i) sum = code_.time_arithmetic(op, sum, natural(args[i]));
    return sum.value;
  }
  ir::ValueId result = operand(args[0]);
  for (size_t i = 1; i < args.size(); ++i) {
    result = code_.number_op(op, own, result, operand(args[i]));
  }
  return result;
}

// Counts beyond the width are all the same, so they may be cut to what fits a u32.
ir::ValueId StandardCode::shift(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                                ir::TypeId own) {
  ir::ValueId in = value(args[0], own);
  Typed count = natural(args[1]);
  ir::Scalar machine = scalar(count.type);
  ir::ValueId number = count.value;
  if (ir::scalar_size(machine) == 8 && row.id != FunctionId::kRol && row.id != FunctionId::kRor) {
    number = code_.machine_convert(number, machine, ir::Scalar::kU64);
    number = build_.binary(ir::Op::kMin, ir::Scalar::kU64, number,
                           build_.constant(ir::Scalar::kU64, 64));
    machine = ir::Scalar::kU64;
  }
  number = code_.machine_convert(number, machine, ir::Scalar::kU32);
  return build_.binary(shift_op(row.id), scalar(own), in, number);
}

ir::ValueId ValueCode::extreme_of(bool largest, ir::TypeId type, ir::ValueId a, ir::ValueId b) {
  ir::Scalar machine = scalar(type);
  if (machine == ir::Scalar::kBool) {
    return build_.binary(largest ? ir::Op::kOr : ir::Op::kAnd, machine, a, b);
  }
  return build_.binary(largest ? ir::Op::kMax : ir::Op::kMin, machine, a, b);
}

ir::ValueId StandardCode::extreme(const std::vector<ExprId>& args, const stdlib::FunctionRow& row,
                                  ir::TypeId own) {
  if (row.id == FunctionId::kLimit) {
    ir::ValueId low = value(args[0], own);
    ir::ValueId in = value(args[1], own);
    ir::ValueId high = value(args[2], own);
    return code_.extreme_of(false, own, code_.extreme_of(true, own, in, low), high);
  }
  ir::ValueId result = value(args[0], own);
  for (size_t i = 1; i < args.size(); ++i) {
    result = code_.extreme_of(row.id == FunctionId::kMax, own, result, value(args[i], own));
  }
  return result;
}

// Out of range takes the nearest argument: the comparisons say so by themselves.
ir::ValueId StandardCode::multiplex(const std::vector<ExprId>& args, ir::TypeId own) {
  Typed selector = natural(args[0]);
  ir::ValueId wide_selector =
      code_.machine_convert(selector.value, scalar(selector.type), ir::Scalar::kI64);
  ir::ValueId result = value(args[1], own);
  for (size_t i = 2; i < args.size(); ++i) {
    ir::ValueId next = value(args[i], own);
    ir::ValueId number = build_.constant(ir::Scalar::kI64, i - 1);
    ir::ValueId reached = build_.compare(ir::Op::kLe, ir::Scalar::kI64, number, wide_selector);
    result = build_.select(scalar(own), reached, result, next);
  }
  return result;
}

// Every argument is evaluated once; each is compared with the next.
ir::ValueId StandardCode::compare_chain(const std::vector<ExprId>& args, BinaryOp op,
                                        ir::TypeId common) {
  if (!common.valid()) return code_.zero(elementary(ir::Kind::kBool));
  bool text = is_string(types(), common);
  const ir::TypeId narrow = compared_type(*this, common, args);
  common = compared_with_literals(*this, narrow, args);
  if (common != narrow && args.size() == 2) warn_of_decided(*this, op, args[0], args[1], narrow);
  ir::ValueList values;
  std::vector<ir::Place> places;
  for (ExprId arg : args) {
    if (text) {
      places.push_back(place(arg));
    } else {
      values.push_back(value(arg, common));
    }
  }
  ir::ValueId all;
  for (size_t i = 0; i + 1 < args.size(); ++i) {
    ir::ValueId next = text ? code_.compare_places(op, places[i], places[i + 1])
                            : code_.compare_scalars(op, common, values[i], values[i + 1]);
    all = i == 0 ? next : build_.binary(ir::Op::kAnd, ir::Scalar::kBool, all, next);
  }
  return all;
}

}  // namespace frontend
