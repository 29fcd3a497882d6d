#include "tools/stvm/condition.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <optional>

#include "base/joined.h"
#include "ir/bytecode/variable_names.h"

namespace stvm {
namespace {

using Op = ConditionOp;
using Type = ConditionType;
using Value = ConditionValue;

// How many values a step takes from the stack.
size_t operands_of(Op op) {
  if (op <= Op::kBool) return 0;
  return op <= Op::kAbs ? 1 : 2;
}

const char* op_name(Op op) {
  constexpr const char* kNames[] = {"",    "",   "",    "",  "",   "NOT", "-",   "ABS",
                                    "AND", "OR", "XOR", "=", "<>", "<",   "<=",  ">",
                                    ">=",  "+",  "-",   "*", "/",  "MOD", "MIN", "MAX"};
  return kNames[static_cast<size_t>(op)];
}

bool compares(Op op) { return op >= Op::kEqual && op <= Op::kGreaterEqual; }
bool of_bools(Op op) { return op == Op::kNot || (op >= Op::kAnd && op <= Op::kXor); }

// What a step makes of its operands, of which the last is `b`.
base::Result<Type> type_after(Op op, Type a, Type b) {
  const bool bools = a == Type::kBool && b == Type::kBool;
  const bool numbers = a != Type::kBool && b != Type::kBool;
  const bool real = a == Type::kReal || b == Type::kReal;
  const bool equality = op == Op::kEqual || op == Op::kNotEqual;
  const bool fits =
      of_bools(op) ? bools : (numbers && !(op == Op::kModulo && real)) || (equality && bools);
  if (!fits) {
    std::string types(condition_type_name(a));
    if (operands_of(op) == 2) types = base::joined({types, " and ", condition_type_name(b)});
    return base::Error{base::Refusal::kBadValue,
                       base::joined({"`", op_name(op), "` does not take ", types})};
  }
  if (compares(op) || of_bools(op)) return Type::kBool;
  return real ? Type::kReal : Type::kInteger;
}

template <class T>
T at(const uint8_t* memory) {
  T value;
  std::memcpy(&value, memory, sizeof value);
  return value;
}

template <class T>
bool compared(Op op, T a, T b) {
  switch (op) {
    case Op::kEqual:
      return a == b;
    case Op::kNotEqual:
      return a != b;
    case Op::kLess:
      return a < b;
    case Op::kLessEqual:
      return a <= b;
    case Op::kGreater:
      return a > b;
    default:
      return a >= b;
  }
}

// What stops it, if anything.
using Stop = std::optional<Computed>;

Stop of_integers(Op op, int64_t a, int64_t b, int64_t& out) {
  bool over = false;
  const bool divides = op == Op::kDivide || op == Op::kModulo;
  if (divides && b == 0) return Computed::kByZero;
  switch (op) {
    case Op::kAdd:
      over = __builtin_add_overflow(a, b, &out);
      break;
    case Op::kSubtract:
      over = __builtin_sub_overflow(a, b, &out);
      break;
    case Op::kMultiply:
      over = __builtin_mul_overflow(a, b, &out);
      break;
    case Op::kDivide:
      over = a == INT64_MIN && b == -1;
      if (!over) out = a / b;
      break;
    case Op::kModulo:
      out = b == -1 ? 0 : a % b;
      break;
    case Op::kMin:
      out = a < b ? a : b;
      break;
    default:
      out = a < b ? b : a;
      break;
  }
  return over ? Stop(Computed::kOverflow) : std::nullopt;
}

Stop of_reals(Op op, double a, double b, double& out) {
  if (op == Op::kDivide && b == 0) return Computed::kByZero;
  switch (op) {
    case Op::kAdd:
      out = a + b;
      break;
    case Op::kSubtract:
      out = a - b;
      break;
    case Op::kMultiply:
      out = a * b;
      break;
    case Op::kDivide:
      out = a / b;
      break;
    case Op::kMin:
      out = std::fmin(a, b);
      break;
    default:
      out = std::fmax(a, b);
      break;
  }
  return std::nullopt;
}

double real_of(const Value& value) {
  return value.type == Type::kReal ? value.real : static_cast<double>(value.integer);
}

Stop unary(Op op, Value& value) {
  if (op == Op::kNot) {
    value.integer = value.integer == 0;
    return std::nullopt;
  }
  if (value.type == Type::kReal) {
    value.real = op == Op::kNegate ? -value.real : std::fabs(value.real);
    return std::nullopt;
  }
  if (op == Op::kAbs && value.integer >= 0) return std::nullopt;
  return of_integers(Op::kSubtract, 0, value.integer, value.integer);
}

Stop binary(Op op, Value& a, const Value& b) {
  const bool real = a.type == Type::kReal || b.type == Type::kReal;
  if (compares(op)) {
    const bool holds =
        real ? compared(op, real_of(a), real_of(b)) : compared(op, a.integer, b.integer);
    a = {Type::kBool, holds ? 1 : 0, 0};
    return std::nullopt;
  }
  if (of_bools(op)) {
    a.integer = op == Op::kAnd  ? a.integer & b.integer
                : op == Op::kOr ? a.integer | b.integer
                                : a.integer ^ b.integer;
    return std::nullopt;
  }
  if (!real) return of_integers(op, a.integer, b.integer, a.integer);
  const double left = real_of(a);
  a.type = Type::kReal;
  return of_reals(op, left, real_of(b), a.real);
}

}  // namespace

std::string_view condition_type_name(ConditionType type) {
  constexpr std::string_view kNames[] = {"BOOL", "a whole number", "REAL"};
  return kNames[static_cast<size_t>(type)];
}

std::string condition_text(const ConditionValue& value) {
  if (value.type == Type::kBool) return value.integer != 0 ? "TRUE" : "FALSE";
  if (value.type == Type::kInteger) return std::to_string(value.integer);
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", value.real);
  return text;
}

base::Result<ConditionVariable> condition_variable(const ir::Image& image,
                                                   const std::string& name) {
  base::Result<ir::Symbol> symbol = ir::named_symbol(image, name);
  if (!symbol.ok()) return symbol.error();
  ConditionVariable out{symbol->data, symbol->bit_mask, ir::Kind::kBool};
  if (symbol->bit_mask != 0) return out;
  ir::TypeId type = symbol->type;
  while (image.types[type].kind == ir::Kind::kEnum ||
         image.types[type].kind == ir::Kind::kSubrange) {
    type = image.types[type].base;
  }
  out.kind = image.types[type].kind;
  if (out.kind <= ir::Kind::kLreal) return out;
  return base::Error{base::Refusal::kBadValue,
                     "`" + name + "` is " + image.types.text(symbol->type) +
                         "; conditions know BOOL, numbers, bit strings and enumerations"};
}

ConditionType condition_type(const ConditionVariable& variable) {
  if (variable.kind == ir::Kind::kBool) return Type::kBool;
  const bool real = variable.kind == ir::Kind::kReal || variable.kind == ir::Kind::kLreal;
  return real ? Type::kReal : Type::kInteger;
}

bool read_variable(const ConditionVariable& variable, const uint8_t* memory, Value& value) {
  const uint8_t* const data = memory + variable.data;
  value = {condition_type(variable), 0, 0};
  switch (variable.kind) {
    case ir::Kind::kBool:
      value.integer = variable.bit_mask != 0 ? (*data & variable.bit_mask) != 0 : *data != 0;
      return true;
    case ir::Kind::kSint:
      value.integer = at<int8_t>(data);
      return true;
    case ir::Kind::kInt:
      value.integer = at<int16_t>(data);
      return true;
    case ir::Kind::kDint:
      value.integer = at<int32_t>(data);
      return true;
    case ir::Kind::kUsint:
    case ir::Kind::kByte:
      value.integer = *data;
      return true;
    case ir::Kind::kUint:
    case ir::Kind::kWord:
      value.integer = at<uint16_t>(data);
      return true;
    case ir::Kind::kUdint:
    case ir::Kind::kDword:
      value.integer = at<uint32_t>(data);
      return true;
    case ir::Kind::kReal:
      value.real = static_cast<double>(at<float>(data));
      return true;
    case ir::Kind::kLreal:
      value.real = at<double>(data);
      return true;
    default:
      value.integer = at<int64_t>(data);
      return variable.kind == ir::Kind::kLint || value.integer >= 0;
  }
}

base::Status check_condition(const Condition& condition,
                             std::span<const ConditionVariable> variables) {
  const auto bad = [](std::string text) {
    return base::Error{base::Refusal::kBadValue, std::move(text)};
  };
  if (condition.steps.size() > kMostConditionSteps) return bad("a condition is too long");
  std::array<Type, kMostConditionDepth> stack;
  size_t depth = 0;
  for (const ConditionStep& step : condition.steps) {
    const size_t takes = operands_of(step.op);
    if (depth < takes) return bad("a condition lacks an operand");
    if (takes == 0) {
      if (depth == stack.size()) return bad("a condition is nested too deeply");
      const bool loads = step.op <= Op::kBaseline;
      if (loads && step.operand >= variables.size()) return bad("a condition lacks a variable");
      stack[depth++] = loads                     ? condition_type(variables[step.operand])
                       : step.op == Op::kInteger ? Type::kInteger
                       : step.op == Op::kReal    ? Type::kReal
                                                 : Type::kBool;
      continue;
    }
    depth -= takes;
    base::Result<Type> type = type_after(step.op, stack[depth], stack[depth + takes - 1]);
    if (!type.ok()) return type.error();
    stack[depth++] = *type;
  }
  if (depth != 1) return bad("a condition is one expression");
  if (stack[0] == Type::kBool) return base::Ok{};
  return bad(base::joined({"a condition is BOOL, and this is ", condition_type_name(stack[0])}));
}

Computed compute(const Condition& condition, std::span<const Value> now,
                 std::span<const Value> baseline) {
  std::array<Value, kMostConditionDepth> stack;
  size_t depth = 0;
  for (const ConditionStep& step : condition.steps) {
    Stop stop;
    switch (step.op) {
      case Op::kVariable:
        stack[depth++] = now[step.operand];
        break;
      case Op::kBaseline:
        stack[depth++] = baseline[step.operand];
        break;
      case Op::kInteger:
        stack[depth++] = {Type::kInteger, static_cast<int64_t>(step.operand), 0};
        break;
      case Op::kReal:
        stack[depth++] = {Type::kReal, 0, std::bit_cast<double>(step.operand)};
        break;
      case Op::kBool:
        stack[depth++] = {Type::kBool, step.operand != 0 ? 1 : 0, 0};
        break;
      case Op::kNot:
      case Op::kNegate:
      case Op::kAbs:
        stop = unary(step.op, stack[depth - 1]);
        break;
      default:
        --depth;
        stop = binary(step.op, stack[depth - 1], stack[depth]);
        break;
    }
    if (stop) return *stop;
  }
  return stack[0].integer != 0 ? Computed::kTrue : Computed::kFalse;
}

}  // namespace stvm
