// Operators on constants.
#include <cmath>

#include "frontend/sema/constants/folder.h"
#include "frontend/sema/expressions/operators.h"
#include "ir/types/not_a_number.h"

namespace frontend {

std::optional<Constant> Folder::compare(const Expr& expr, const Constant& a, const Constant& b) {
  int order = 0;
  bool unordered = false;
  if (a.form == Constant::Form::kText) {
    order = a.text.compare(b.text);
  } else if (a.form == Constant::Form::kReal || b.form == Constant::Form::kReal) {
    double x = real_of(a);
    double y = real_of(b);
    unordered = std::isnan(x) || std::isnan(y);
    order = x < y ? -1 : x > y ? 1 : 0;
  } else {
    order = a.integer < b.integer ? -1 : a.integer > b.integer ? 1 : 0;
  }
  bool holds = false;
  switch (expr.binary) {
    case BinaryOp::kEq:
      holds = order == 0;
      break;
    case BinaryOp::kNe:
      holds = order != 0;
      break;
    case BinaryOp::kLt:
      holds = order < 0;
      break;
    case BinaryOp::kLe:
      holds = order <= 0;
      break;
    case BinaryOp::kGt:
      holds = order > 0;
      break;
    default:
      holds = order >= 0;
      break;
  }
  if (unordered) holds = expr.binary == BinaryOp::kNe;
  Constant result;
  result.type = sema_.program.types.elementary(ir::Kind::kBool);
  result.integer = holds ? 1 : 0;
  return result;
}

std::optional<Constant> Folder::real_binary(const Expr& expr, double a, double b, Constant result) {
  double value = 0;
  switch (expr.binary) {
    case BinaryOp::kAdd:
      value = a + b;
      break;
    case BinaryOp::kSub:
      value = a - b;
      break;
    case BinaryOp::kMul:
      value = a * b;
      break;
    case BinaryOp::kDiv:
      value = a / b;
      break;
    default:
      error(DiagnosticCode::kBadOperand, expr.span,
            std::string(operator_text(expr.binary)) + " is not defined for reals",
            "convert what it gives: TO_REAL(WORD#2#1010 AND WORD#2#1100)");
      return std::nullopt;
  }
  value = ir::with_nan_of(value, a, b);
  Traits traits = traits_of(sema_.program.types, result.type);
  if (result.flex == Flex::kNone && traits.duration) {
    if (!(std::fabs(value) < 9.2e18)) {
      error(DiagnosticCode::kConstantOverflow, expr.span, "the duration does not fit");
      return std::nullopt;
    }
    result.integer = static_cast<Wide>(std::nearbyint(value));
    return result;
  }
  result.form = Constant::Form::kReal;
  bool single =
      result.flex == Flex::kNone && sema_.program.types.scalar(result.type) == ir::Scalar::kF32;
  result.real = single ? static_cast<double>(static_cast<float>(value)) : value;
  return result;
}

std::optional<Constant> Folder::integer_binary(const Expr& expr, Wide a, Wide b, Constant result) {
  switch (expr.binary) {
    case BinaryOp::kAdd:
      return exact(result, a + b, expr);
    case BinaryOp::kSub:
      return exact(result, a - b, expr);
    case BinaryOp::kMul: {
      Wide product = 0;
      if (__builtin_mul_overflow(a, b, &product)) product = kMaxExact * kMaxExact;
      return exact(result, product, expr);
    }
    case BinaryOp::kDiv:
    case BinaryOp::kMod:
      if (b == 0) {
        error(DiagnosticCode::kConstantDivision, expr.span, "the divisor is 0");
        return std::nullopt;
      }
      return exact(result, expr.binary == BinaryOp::kDiv ? a / b : a % b, expr);
    case BinaryOp::kAnd:
    case BinaryOp::kAndThen:
      return exact(result, a & b, expr);
    case BinaryOp::kOr:
    case BinaryOp::kOrElse:
      return exact(result, a | b, expr);
    case BinaryOp::kXor:
      return exact(result, a ^ b, expr);
    default:
      return std::nullopt;
  }
}

}  // namespace frontend
