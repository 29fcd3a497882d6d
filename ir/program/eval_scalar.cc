#include "ir/program/eval_scalar.h"

#include <bit>
#include <cmath>

#include "ir/types/not_a_number.h"

namespace ir {
namespace {

template <class Float>
Float to_float(uint64_t bits) {
  if constexpr (sizeof(Float) == 4) {
    return std::bit_cast<float>(static_cast<uint32_t>(bits));
  } else {
    return std::bit_cast<double>(bits);
  }
}

uint64_t from_float(float value) { return std::bit_cast<uint32_t>(value); }
uint64_t from_float(double value) { return std::bit_cast<uint64_t>(value); }

uint32_t width_of(Scalar scalar) { return scalar_size(scalar) * 8; }

Outcome division_by_zero(Op op, Scalar scalar, uint64_t a) {
  return {0, TrapKind::kDivisionByZero,
          integer_text(scalar, a) + (op == Op::kDiv ? " / 0" : " MOD 0")};
}

// The most negative value divided by -1 wraps to itself; its remainder is 0.
Outcome divide(Op op, Scalar scalar, uint64_t a, uint64_t b) {
  if (b == 0) {
    return division_by_zero(op, scalar, a);
  }
  if (!is_signed(scalar)) {
    return {op == Op::kDiv ? a / b : a % b, {}, {}};
  }
  const int64_t dividend = static_cast<int64_t>(a);
  const int64_t divisor = static_cast<int64_t>(b);
  if (divisor == -1) {
    return {op == Op::kDiv ? canonical(scalar, 0 - a) : 0, {}, {}};
  }
  return {static_cast<uint64_t>(op == Op::kDiv ? dividend / divisor : dividend % divisor), {}, {}};
}

bool less(Scalar scalar, uint64_t a, uint64_t b) {
  return is_signed(scalar) ? static_cast<int64_t>(a) < static_cast<int64_t>(b) : a < b;
}

Outcome integer_binary(Op op, Scalar scalar, uint64_t a, uint64_t b) {
  switch (op) {
    case Op::kAdd:
      return {canonical(scalar, a + b), {}, {}};
    case Op::kSub:
      return {canonical(scalar, a - b), {}, {}};
    case Op::kMul:
      return {canonical(scalar, a * b), {}, {}};
    case Op::kDiv:
    case Op::kMod:
      return divide(op, scalar, a, b);
    case Op::kMin:
      return {less(scalar, b, a) ? b : a, {}, {}};
    case Op::kMax:
      return {less(scalar, a, b) ? b : a, {}, {}};
    case Op::kAnd:
      return {a & b, {}, {}};
    case Op::kOr:
      return {a | b, {}, {}};
    case Op::kXor:
      return {a ^ b, {}, {}};
    case Op::kEq:
      return {a == b, {}, {}};
    case Op::kNe:
      return {a != b, {}, {}};
    case Op::kLt:
      return {less(scalar, a, b), {}, {}};
    default:
      return {!less(scalar, b, a), {}, {}};
  }
}

template <class Float>
uint64_t float_binary(Op op, Float a, Float b) {
  switch (op) {
    case Op::kAdd:
      return from_float(with_nan_of(static_cast<Float>(a + b), a, b));
    case Op::kSub:
      return from_float(with_nan_of(static_cast<Float>(a - b), a, b));
    case Op::kMul:
      return from_float(with_nan_of(static_cast<Float>(a * b), a, b));
    case Op::kDiv:
      return from_float(with_nan_of(static_cast<Float>(a / b), a, b));
    case Op::kMin:
      return from_float(b < a ? b : a);
    case Op::kMax:
      return from_float(a < b ? b : a);
    case Op::kEq:
      return a == b;
    case Op::kNe:
      return a != b;
    case Op::kLt:
      return a < b;
    default:
      return a <= b;
  }
}

template <class Float>
uint64_t float_unary(Op op, Float a) {
  switch (op) {
    case Op::kNeg:
      return from_float(-a);
    case Op::kAbs:
      return from_float(std::fabs(a));
    default:
      return from_float(with_nan_of(std::sqrt(a), a, a));
  }
}

// Every f32 and every bound below is exact in f64.
Outcome to_integer(double value, Scalar to) {
  const int width = static_cast<int>(width_of(to));
  const double low = is_signed(to) ? -std::ldexp(1.0, width - 1) : 0.0;
  const double above = std::ldexp(1.0, is_signed(to) ? width - 1 : width);
  if (!(value >= low && value < above)) {
    return {0, TrapKind::kConversion,
            std::to_string(value) + " as " + std::string(scalar_name(to))};
  }
  const uint64_t bits = is_signed(to) ? static_cast<uint64_t>(static_cast<int64_t>(value))
                                      : static_cast<uint64_t>(value);
  return {bits, {}, {}};
}

template <class Float>
uint64_t float_from(Scalar from, uint64_t a) {
  switch (from) {
    case Scalar::kF32:
      return from_float(static_cast<Float>(to_float<float>(a)));
    case Scalar::kF64:
      return from_float(static_cast<Float>(to_float<double>(a)));
    default:
      return from_float(is_signed(from) ? static_cast<Float>(static_cast<int64_t>(a))
                                        : static_cast<Float>(a));
  }
}

double as_double(Scalar from, uint64_t a) {
  return from == Scalar::kF32 ? static_cast<double>(to_float<float>(a)) : to_float<double>(a);
}

}  // namespace

uint64_t canonical(Scalar scalar, uint64_t bits) {
  if (scalar == Scalar::kBool) {
    return bits & 1;
  }
  const uint32_t unused = 64 - width_of(scalar);
  const uint64_t high = bits << unused;
  return is_signed(scalar) ? static_cast<uint64_t>(static_cast<int64_t>(high) >> unused)
                           : high >> unused;
}

std::string integer_text(Scalar scalar, uint64_t bits) {
  return is_signed(scalar) ? std::to_string(static_cast<int64_t>(bits)) : std::to_string(bits);
}

Outcome eval_binary(Op op, Scalar scalar, uint64_t a, uint64_t b) {
  switch (scalar) {
    case Scalar::kF32:
      return {float_binary(op, to_float<float>(a), to_float<float>(b)), {}, {}};
    case Scalar::kF64:
      return {float_binary(op, to_float<double>(a), to_float<double>(b)), {}, {}};
    default:
      return integer_binary(op, scalar, a, b);
  }
}

uint64_t eval_unary(Op op, Scalar scalar, uint64_t a) {
  if (scalar == Scalar::kF32) {
    return float_unary(op, to_float<float>(a));
  }
  if (scalar == Scalar::kF64) {
    return float_unary(op, to_float<double>(a));
  }
  switch (op) {
    case Op::kNot:
      return canonical(scalar, ~a);
    case Op::kAbs:
      return is_signed(scalar) && static_cast<int64_t>(a) < 0 ? canonical(scalar, 0 - a) : a;
    default:
      return canonical(scalar, 0 - a);
  }
}

uint64_t eval_shift(Op op, Scalar scalar, uint64_t a, uint32_t count) {
  const uint32_t width = width_of(scalar);
  const uint64_t mask = width == 64 ? ~uint64_t{0} : (uint64_t{1} << width) - 1;
  const uint64_t bits = a & mask;
  const uint32_t turn = count % width;
  const uint64_t left = bits << turn | (turn == 0 ? 0 : bits >> (width - turn));
  const uint64_t right = bits >> turn | (turn == 0 ? 0 : bits << (width - turn));
  switch (op) {
    case Op::kShl:
      return count >= width ? 0 : canonical(scalar, bits << count);
    case Op::kShr:
      return count >= width ? 0 : canonical(scalar, bits >> count);
    case Op::kRol:
      return canonical(scalar, left);
    default:
      return canonical(scalar, right);
  }
}

Outcome eval_conversion(Op op, Scalar from, Scalar to, uint64_t a) {
  switch (op) {
    case Op::kToFloat:
      return {
          to == Scalar::kF32 ? float_from<float>(from, a) : float_from<double>(from, a), {}, {}};
    case Op::kRound:
      // The rounding mode is never changed, so nearbyint is half to even.
      return to_integer(std::nearbyint(as_double(from, a)), to);
    case Op::kTrunc:
      return to_integer(std::trunc(as_double(from, a)), to);
    case Op::kToBool:
      return {a != 0, {}, {}};
    default:
      return {canonical(to, a), {}, {}};
  }
}

Outcome eval_check_range(Scalar scalar, uint64_t a, int64_t low, int64_t high) {
  // A u64's bounds are bit patterns; narrower unsigned values are the same either way.
  const bool inside = scalar == Scalar::kU64
                          ? a >= static_cast<uint64_t>(low) && a <= static_cast<uint64_t>(high)
                          : static_cast<int64_t>(a) >= low && static_cast<int64_t>(a) <= high;
  if (inside) {
    return {a, {}, {}};
  }
  return {0, TrapKind::kSubrange,
          integer_text(scalar, a) + " outside " + integer_text(scalar, static_cast<uint64_t>(low)) +
              ".." + integer_text(scalar, static_cast<uint64_t>(high))};
}

bool is_scalar_operation(Op op) { return op >= Op::kAdd && op <= Op::kCheckStep; }

Outcome eval_operation(const Inst& inst, Scalar from, std::span<const uint64_t> operands) {
  const uint64_t a = operands[0];
  switch (inst.op) {
    case Op::kNeg:
    case Op::kAbs:
    case Op::kSqrt:
    case Op::kNot:
      return {eval_unary(inst.op, inst.scalar, a), {}, {}};
    case Op::kShl:
    case Op::kShr:
    case Op::kRol:
    case Op::kRor:
      return {eval_shift(inst.op, inst.scalar, a, static_cast<uint32_t>(operands[1])), {}, {}};
    case Op::kSelect:
      return {operands[a != 0 ? 2 : 1], {}, {}};
    case Op::kWrap:
    case Op::kToFloat:
    case Op::kRound:
    case Op::kTrunc:
    case Op::kToBool:
    case Op::kBits:
      return eval_conversion(inst.op, from, inst.scalar, a);
    case Op::kCheckRange:
      return eval_check_range(inst.scalar, a, inst.low, inst.high);
    case Op::kCheckStep:
      return a != 0 ? Outcome{a, {}, {}} : Outcome{0, TrapKind::kForStep, "BY 0"};
    default:
      return eval_binary(inst.op, inst.scalar, a, operands[1]);
  }
}

}  // namespace ir
