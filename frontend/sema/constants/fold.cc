// Constant expressions. Values of literals alone stay exact until their context
// gives them a type; typed ones wrap in their width as they would at run time.
#include <cmath>

#include "frontend/sema/calls/calls.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/constants/folder.h"
#include "frontend/sema/expressions/expressions.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"
#include "frontend/sema/types/types.h"
#include "ir/types/natural_layout.h"
#include "ir/types/time_units.h"

namespace frontend {
namespace {

Constant null_of(ir::TypeId type) {
  Constant value;
  value.flex = Flex::kNull;
  value.type = type;
  return value;
}

}  // namespace

std::optional<Constant> Folder::fold(ExprId id) {
  const Expr& expr = sema_.tree[id];
  const Note& note = infer(id);
  if (!note.type.valid()) return std::nullopt;
  if (note.known < least_) {
    error(DiagnosticCode::kNotConstant, expr.span, "this has to be known when compiling",
          "use literals, constants and standard functions of them");
    return std::nullopt;
  }
  switch (expr.kind) {
    case ExprKind::kLiteral:
      return literal(expr);
    case ExprKind::kName:
      return name(id, expr);
    case ExprKind::kQualified:
      return enumerator(note.type, expr);
    case ExprKind::kMember:
      return member(id, expr);
    case ExprKind::kIndex:
      return part(id);
    case ExprKind::kBit:
      return bits_of(id, expr);
    case ExprKind::kCall:
      return call(id);
    case ExprKind::kUnary:
      return unary(id, expr);
    case ExprKind::kBinary:
      return expr.binary == BinaryOp::kPower ? call(id) : binary(id, expr);
    default:
      return std::nullopt;
  }
}

std::optional<Constant> Folder::member(ExprId id, const Expr& expr) {
  const Note& note = infer(id);
  if (note.bit_size != 0 && !note.view) return bits_of(id, expr);
  bool literal = note.constant && !note.variable.valid();
  return literal ? name(id, expr) : part(id);
}

// A variable or part of one, with its initial value.
std::optional<Constant> Folder::part(ExprId id) {
  auto part = ask<Constants>().initial_part(id);
  if (!part) return std::nullopt;
  const ir::TypeTable& types = sema_.program.types;
  ir::ConstId init = part->init;
  for (ir::TypeId type = part->type; !init.valid() && type.valid(); type = types[type].base) {
    init = types[type].init;
  }
  if (is_string(types, part->type)) {
    Constant value;
    value.form = Constant::Form::kText;
    value.type = part->type;
    if (init.valid()) value.text = sema_.program.constants[init].text;
    return value;
  }
  if (!types.is_scalar(part->type)) {
    error(DiagnosticCode::kBadInitializer, sema_.tree[id].span,
          "this is a whole `" + sema_.report.type_text(part->type) + "`",
          "name the member or element that is meant");
    return std::nullopt;
  }
  return of_bits(part->type, init.valid() ? sema_.program.constants[init].bits : 0);
}

std::optional<Constant> Folder::bits_of(ExprId id, const Expr& expr) {
  const Note note = infer(id);
  ir::TypeId saved = context_;
  context_ = {};
  auto whole = fold(expr.operand);
  context_ = saved;
  if (!whole) return std::nullopt;
  Wide mask = (static_cast<Wide>(1) << note.bit_size) - 1;
  Constant value;
  value.type = note.type;
  value.integer = (whole->integer >> (note.bit_number * note.bit_size)) & mask;
  return value;
}

// What a call gives is not repeated here: it is lowered and run as any other code.
std::optional<Constant> Folder::call(ExprId id) {
  const Expr& expr = sema_.tree[id];
  if (expr.kind == ExprKind::kCall) {
    Callee callee = ask<Calls>().callee(expr);
    if (callee.kind == Callee::Kind::kBound) {
      auto bound = ask<Calls>().bound_of(expr, callee.upper);
      if (!bound) return std::nullopt;
      Constant value;
      value.type = infer(id).type;
      value.integer = *bound;
      return value;
    }
    if (callee.reference == ReferenceCall::kSizeof) {
      const ExprId argument = sema_.tree.args[expr.list.first].value;
      Constant value;
      value.flex = Flex::kInteger;
      value.integer =
          ir::natural_size(sema_.program.types, ask<Calls>().type_of_argument(argument));
      return value;
    }
  }
  return evaluate_constant(sema_, scope_, id, context_);
}

std::optional<Constant> Folder::literal(const Expr& expr) {
  const Literal& literal = sema_.tree.literals[expr.number];
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
      value.text = sema_.tree.texts[literal.text];
      value.flex = Flex::kText;
      value.type = literal.kind == LiteralKind::kString ? sema_.program.types.string(1)
                                                        : sema_.program.types.wstring(1);
      break;
    default:
      value.integer = literal.integer;
      value.pattern = literal.based && !literal.negative;
      if (literal.kind == LiteralKind::kInteger)
        value.flex = Flex::kInteger;
      else
        value.integer = static_cast<int64_t>(literal.integer);
      if (literal.negative) value.integer = -value.integer;
      if (literal.kind != LiteralKind::kInteger) {
        value.type =
            without_range(sema_.program.types, ask<Expressions>().infer_literal(expr).type);
      }
      break;
  }
  if (literal.prefix == kNoNumber) return value;
  // A typed literal has to fit its prefix: INT#40000 does not.
  ir::TypeId type = ask<Expressions>().infer_literal(expr).type;
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
  auto bits = ask<Constants>().fit(value, type, expr.span);
  if (!bits) return std::nullopt;
  value = of_bits(type, *bits);
  value.literal = true;
  return value;
}

std::optional<Constant> Folder::name(ExprId id, const Expr& expr) {
  const Note& note = infer(id);
  if (!note.variable.valid()) {
    ir::TypeId type = note.type;
    if (note.flex == Flex::kNull) return null_of(type);
    if (const auto* earlier = sema_.declared.forming_literal(expr.name.text, &type)) {
      Constant value;
      value.flex = Flex::kInteger;
      value.integer = earlier->value;
      return value;
    }
    if (note.flex == Flex::kEnum && context_.valid() && is_enum(sema_.program.types, context_)) {
      type = context_;
    } else if (note.flex == Flex::kEnum) {
      error(DiagnosticCode::kAmbiguousName, expr.span,
            "several enumerations have a literal `" + std::string(expr.name.text) + "`",
            "write the enumeration's name before it: Name#" + std::string(expr.name.text));
      return std::nullopt;
    }
    return enumerator(type, expr);
  }
  return part(id);
}

std::optional<Constant> Folder::enumerator(ir::TypeId type, const Expr& name) {
  ir::TypeId root = without_range(sema_.program.types, type);
  if (const int32_t number = sema_.declared.find_literal(root, name.name.text); number >= 0) {
    const ir::EnumLiteral& literal =
        sema_.program.types[root].literals[static_cast<size_t>(number)];
    return of_bits(root, static_cast<uint64_t>(literal.value));
  }
  // Ambiguous name in the context of a third enumeration: any candidate will be refused.
  auto found =
      sema_.declared.literals.find(sema_.namespaces.find(NameSort::kLiteral, scope_, name));
  if (found == sema_.declared.literals.end()) return std::nullopt;  // NULL, for example
  const ir::TypeId any = ask<Types>().resolve_type(found->second[0].spec).type;
  if (!sema_.program.types.is_scalar(any)) return std::nullopt;
  return of_bits(any, 0);
}

std::optional<Constant> Folder::exact(Constant result, Wide value, const Expr& expr) {
  if (result.flex == Flex::kNone) {
    value = wrap_to(sema_.program.types.scalar(result.type), value);
    if (is_time_of_day(sema_.program.types, result.type)) {
      value = (value % ir::kNsPerDay + ir::kNsPerDay) % ir::kNsPerDay;
    }
  } else if (value > kMaxExact * 4 || value < -kMaxExact * 2) {
    error(DiagnosticCode::kConstantOverflow, expr.span,
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
  const Note& note = infer(id);
  if (note.flex == Flex::kNone) result.type = computed_type(sema_, note);
  if (expr.unary == UnaryOp::kPlus) return result;
  result.pattern = false;
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

// Literals without a point are whole numbers to CODESYS and TwinCAT, whatever wants their quotient.
bool Folder::is_whole_quotient(const Expr& expr, const Note& note) const {
  if (note.flex != Flex::kInteger) return false;
  if (expr.binary == BinaryOp::kMod) return true;
  return expr.binary == BinaryOp::kDiv && sema_.options.dialect != Dialect::kIec;
}

void Folder::warn_of_remainder(const Expr& expr, Wide a, Wide b) const {
  if (expr.binary != BinaryOp::kDiv || a % b == 0) return;
  warning(DiagnosticCode::kWholeQuotient, expr.span,
          "the quotient of whole numbers is whole: " + wide_text(a / b),
          "write one of them with a point, as 2.0");
}

std::optional<Constant> Folder::binary(ExprId id, const Expr& expr) {
  const Note note = infer(id);
  ir::TypeId saved = context_;
  const ir::TypeId own = note.any_sign ? signed_by_context(sema_.program.types, note, saved)
                                       : computed_type(sema_, note);
  if (operator_class(expr.binary) == OperatorClass::kComparison) {
    context_ = ask<OperatorTypes>().unify(infer(expr.operand), infer(expr.right), expr.span).type;
  } else if (note.flex == Flex::kNone) {
    context_ = own;
  }
  const bool whole = is_whole_quotient(expr, note);
  const bool for_real = whole && context_is_real();
  if (whole) context_ = {};
  auto a = fold(expr.operand);
  auto b = fold(expr.right);
  std::optional<Constant> out;
  if (a && b) {
    if (operator_class(expr.binary) == OperatorClass::kComparison) {
      out = compare(expr, *a, *b);
    } else {
      Constant result;
      result.flex = note.flex;
      result.type = own;
      bool real = note.flex == Flex::kNone ? traits_of(sema_.program.types, note.type).real
                                           : note.flex == Flex::kReal || context_is_real();
      bool scaled = a->form == Constant::Form::kReal || b->form == Constant::Form::kReal;
      if (real || scaled) {
        out = real_binary(expr, real_of(*a), real_of(*b), result);
      } else {
        out = integer_binary(expr, a->integer, b->integer, result);
        if (out && for_real) warn_of_remainder(expr, a->integer, b->integer);
        bool logical = operator_class(expr.binary) == OperatorClass::kLogical;
        if (out) out->pattern = logical && a->pattern && b->pattern;
      }
      if (out) out->literal = a->literal || b->literal;
    }
  }
  context_ = saved;
  return out;
}

std::optional<Constant> Constants::fold(ExprId expr, ir::TypeId context, Known least) {
  if (!infer(expr).type.valid()) return std::nullopt;
  return Folder(sema_, scope_, context, least).fold(expr);
}

}  // namespace frontend
