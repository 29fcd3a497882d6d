// Constant expressions. Values of literals alone stay exact until their context
// gives them a type; typed ones wrap in their width as they would at run time.
#include <bit>
#include <cmath>

#include "frontend/sema/operators.h"
#include "frontend/sema/sema.h"

namespace frontend {
namespace {

// Exact integers may grow to this before they are refused: far beyond any type, and
// products of two of them still fit.
constexpr Wide kMaxExact = static_cast<Wide>(1) << 62;

}  // namespace

// Evaluates one expression known to be constant; all states of failure are reported.
class Folder {
 public:
  Folder(Sema& sema, ir::TypeId context) : sema_(sema), context_(context) {}
  std::optional<Constant> fold(ExprId id);

 private:
  std::optional<Constant> literal(const Expr& expr);
  std::optional<Constant> name(ExprId id, const Expr& expr);
  std::optional<Constant> enumerator(ir::TypeId type, std::string_view name);
  std::optional<Constant> unary(ExprId id, const Expr& expr);
  std::optional<Constant> binary(ExprId id, const Expr& expr);
  std::optional<Constant> compare(const Expr& expr, const Constant& a, const Constant& b);
  std::optional<Constant> real_binary(const Expr& expr, double a, double b, Constant result);
  std::optional<Constant> integer_binary(const Expr& expr, Wide a, Wide b, Constant result);
  std::optional<Constant> exact(Constant result, Wide value, const Expr& expr);
  Constant of_bits(ir::TypeId type, uint64_t bits) const;
  double real_of(const Constant& value) const {
    return value.form == Constant::Form::kReal ? value.real : static_cast<double>(value.integer);
  }
  bool context_is_real() const {
    return context_.valid() && traits_of(sema_.program.types, context_).real;
  }

  Sema& sema_;
  ir::TypeId context_;
};

std::optional<Constant> Folder::fold(ExprId id) {
  const Expr& expr = sema_.tree[id];
  const Note& note = sema_.infer(id);
  if (!note.type.valid()) return std::nullopt;
  if (!note.constant) {
    sema_.error(DiagnosticCode::kNotConstant, expr.span, "this has to be known when compiling",
                "use literals, constants and enumeration literals");
    return std::nullopt;
  }
  switch (expr.kind) {
    case ExprKind::kLiteral:
      return literal(expr);
    case ExprKind::kName:
      return name(id, expr);
    case ExprKind::kQualified:
    case ExprKind::kMember:
      return enumerator(note.type, expr.name.text);
    case ExprKind::kUnary:
      return unary(id, expr);
    case ExprKind::kBinary:
      return binary(id, expr);
    default:
      return std::nullopt;
  }
}

std::optional<Constant> Folder::literal(const Expr& expr) {
  const Literal& literal = sema_.tree.literals[expr.literal];
  Constant value;
  switch (literal.kind) {
    case LiteralKind::kReal:
      value.form = Constant::Form::kReal;
      value.real = literal.negative ? -literal.real : literal.real;
      value.flex = Flex::kReal;
      break;
    case LiteralKind::kString:
    case LiteralKind::kWstring:
      value.form = Constant::Form::kText;
      value.text = literal.text;
      value.flex = Flex::kText;
      value.type = literal.kind == LiteralKind::kString ? sema_.program.types.string(1)
                                                        : sema_.program.types.wstring(1);
      break;
    default:
      value.integer = literal.integer;
      if (literal.kind == LiteralKind::kInteger)
        value.flex = Flex::kInteger;
      else
        value.integer = static_cast<int64_t>(literal.integer);
      if (literal.negative) value.integer = -value.integer;
      if (literal.kind != LiteralKind::kInteger) {
        value.type = without_range(sema_.program.types, sema_.infer_literal(expr).type);
      }
      break;
  }
  if (literal.prefix.empty()) return value;
  // A typed literal has to fit its prefix: INT#40000 does not.
  ir::TypeId type = sema_.infer_literal(expr).type;
  if (!type.valid()) return std::nullopt;
  if (is_string(sema_.program.types, type)) {
    value.type = type;
    value.flex = Flex::kNone;
    return value;
  }
  bool based = literal.based && value.flex == Flex::kInteger;
  if (based && ir::is_signed(sema_.program.types.scalar(type))) {
    // INT#16#FFFF names a bit pattern.
    Wide span = static_cast<Wide>(1) << (ir::scalar_size(sema_.program.types.scalar(type)) * 8);
    if (value.integer < span)
      value.integer = wrap_to(sema_.program.types.scalar(type), value.integer);
  }
  auto bits = sema_.fit(value, type, expr.span);
  if (!bits) return std::nullopt;
  return of_bits(type, *bits);
}

Constant Folder::of_bits(ir::TypeId type, uint64_t bits) const {
  const ir::TypeTable& types = sema_.program.types;
  Constant value;
  value.type = type;
  ir::Scalar scalar = types.scalar(type);
  if (scalar == ir::Scalar::kF32) {
    value.form = Constant::Form::kReal;
    value.real = std::bit_cast<float>(static_cast<uint32_t>(bits));
  } else if (scalar == ir::Scalar::kF64) {
    value.form = Constant::Form::kReal;
    value.real = std::bit_cast<double>(bits);
  } else {
    value.integer = ir::is_signed(scalar) ? static_cast<Wide>(static_cast<int64_t>(bits))
                                          : static_cast<Wide>(bits);
  }
  return value;
}

std::optional<Constant> Folder::name(ExprId id, const Expr& expr) {
  const Note& note = sema_.infer(id);
  if (!note.variable.valid()) {
    ir::TypeId type = note.type;
    if (note.flex == Flex::kEnum && context_.valid() && is_enum(sema_.program.types, context_)) {
      type = context_;
    } else if (note.flex == Flex::kEnum) {
      sema_.error(DiagnosticCode::kAmbiguousName, expr.span,
                  "several enumerations have a literal `" + std::string(expr.name.text) + "`",
                  "write the enumeration's name before it: Name#" + std::string(expr.name.text));
      return std::nullopt;
    }
    return enumerator(type, expr.name.text);
  }
  const Variable& variable = sema_.resolve(note.variable);
  const ir::TypeTable& types = sema_.program.types;
  ir::ConstId init = variable.init;
  if (!init.valid()) init = types[variable.type].init;
  if (is_string(types, variable.type)) {
    Constant value;
    value.form = Constant::Form::kText;
    value.type = variable.type;
    if (init.valid()) value.text = sema_.program.constants[init].text;
    return value;
  }
  return of_bits(variable.type, init.valid() ? sema_.program.constants[init].bits : 0);
}

std::optional<Constant> Folder::enumerator(ir::TypeId type, std::string_view name) {
  ir::TypeId root = without_range(sema_.program.types, type);
  for (const ir::EnumLiteral& literal : sema_.program.types[root].literals) {
    if (!ir::same_name(literal.name, name)) continue;
    return of_bits(root, static_cast<uint64_t>(literal.value));
  }
  // Ambiguous name in the context of a third enumeration: any candidate will be refused.
  return of_bits(sema_.infer_name_candidates(name), 0);
}

std::optional<Constant> Folder::exact(Constant result, Wide value, const Expr& expr) {
  if (result.flex == Flex::kNone) {
    value = wrap_to(sema_.program.types.scalar(result.type), value);
  } else if (value > kMaxExact * 4 || value < -kMaxExact * 2) {
    sema_.error(DiagnosticCode::kConstantOverflow, expr.span,
                "the value " + wide_text(value) + " fits no type");
    return std::nullopt;
  }
  result.integer = value;
  return result;
}

std::optional<Constant> Folder::unary(ExprId id, const Expr& expr) {
  auto operand = fold(expr.operand);
  if (!operand) return std::nullopt;
  Constant result = *operand;
  const Note& note = sema_.infer(id);
  if (note.flex == Flex::kNone) result.type = note.type;
  if (expr.unary == UnaryOp::kPlus) return result;
  if (expr.unary == UnaryOp::kNegate) {
    if (result.form == Constant::Form::kReal) {
      result.real = -result.real;
      return result;
    }
    return exact(result, -result.integer, expr);
  }
  ir::TypeId type = result.type;
  if (result.flex == Flex::kInteger) {
    // NOT of a bare literal needs a width; the context has it, or there is none.
    type = context_.valid() && sema_.program.types.is_scalar(context_) && !context_is_real()
               ? without_range(sema_.program.types, context_)
               : note.type;
    result.flex = Flex::kNone;
    result.type = type;
  }
  if (sema_.program.types.scalar(type) == ir::Scalar::kBool) {
    result.integer = result.integer == 0 ? 1 : 0;
    return result;
  }
  return exact(result, ~result.integer, expr);
}

std::optional<Constant> Folder::binary(ExprId id, const Expr& expr) {
  const Note note = sema_.infer(id);
  ir::TypeId saved = context_;
  if (operator_class(expr.binary) == OperatorClass::kComparison) {
    context_ = sema_.unify(sema_.infer(expr.operand), sema_.infer(expr.right), expr.span).type;
  } else if (note.flex == Flex::kNone) {
    context_ = note.type;
  }
  auto a = fold(expr.operand);
  auto b = fold(expr.right);
  std::optional<Constant> out;
  if (a && b) {
    if (operator_class(expr.binary) == OperatorClass::kComparison) {
      out = compare(expr, *a, *b);
    } else {
      Constant result;
      result.flex = note.flex;
      result.type = note.type;
      bool real = note.flex == Flex::kNone ? traits_of(sema_.program.types, note.type).real
                                           : note.flex == Flex::kReal || context_is_real();
      bool scaled = a->form == Constant::Form::kReal || b->form == Constant::Form::kReal;
      if (real || scaled) {
        out = real_binary(expr, real_of(*a), real_of(*b), result);
      } else {
        out = integer_binary(expr, a->integer, b->integer, result);
      }
    }
  }
  context_ = saved;
  return out;
}

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
      sema_.error(DiagnosticCode::kBadOperand, expr.span,
                  std::string(operator_text(expr.binary)) + " is not defined for reals");
      return std::nullopt;
  }
  Traits traits = traits_of(sema_.program.types, result.type);
  if (result.flex == Flex::kNone && traits.duration) {
    if (!(std::fabs(value) < 9.2e18)) {
      sema_.error(DiagnosticCode::kConstantOverflow, expr.span, "the duration does not fit");
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
        sema_.error(DiagnosticCode::kConstantDivision, expr.span, "the divisor is 0");
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

std::optional<Constant> Sema::fold(ExprId expr, ir::TypeId context) {
  if (!infer(expr).type.valid()) return std::nullopt;
  return Folder(*this, context).fold(expr);
}

// A type for a literal that no candidate of the context has: the first declared one.
ir::TypeId Sema::infer_name_candidates(std::string_view name) {
  auto found = literals_.find(name);
  return found == literals_.end() ? ir::TypeId() : resolve(found->second[0].spec).type;
}

}  // namespace frontend
