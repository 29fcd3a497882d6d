// Operators: what their operands have in common, and what comes out.
#include <algorithm>

#include "frontend/sema/expressions/operand_warnings.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {
namespace {

Note merged(const Note& a, const Note& b) {
  Note note;
  note.constant = a.constant && b.constant;
  note.calls = a.calls || b.calls;
  note.can_trap = a.can_trap || b.can_trap;
  note.known = std::min(a.known, b.known);
  return note;
}

bool is_flexible_number(const Note& note) {
  return note.flex == Flex::kInteger || note.flex == Flex::kReal;
}

}  // namespace

std::string_view operator_text(BinaryOp op) {
  switch (op) {
    case BinaryOp::kOr:
      return "OR";
    case BinaryOp::kOrElse:
      return "OR_ELSE";
    case BinaryOp::kXor:
      return "XOR";
    case BinaryOp::kAnd:
      return "AND";
    case BinaryOp::kAndThen:
      return "AND_THEN";
    case BinaryOp::kEq:
      return "=";
    case BinaryOp::kNe:
      return "<>";
    case BinaryOp::kLt:
      return "<";
    case BinaryOp::kLe:
      return "<=";
    case BinaryOp::kGt:
      return ">";
    case BinaryOp::kGe:
      return ">=";
    case BinaryOp::kAdd:
      return "+";
    case BinaryOp::kSub:
      return "-";
    case BinaryOp::kMul:
      return "*";
    case BinaryOp::kDiv:
      return "/";
    case BinaryOp::kMod:
      return "MOD";
    case BinaryOp::kPower:
      return "**";
  }
  return "?";
}

// Literals take the other operand's type and never widen it; a real literal beside
// an integer leaves the choice of the real type to the context.
Note OperatorTypes::unify(const Note& a, const Note& b, base::SourceSpan span) {
  Note note = merged(a, b);
  if (!a.type.valid() || !b.type.valid()) return {};
  const ir::TypeTable& types = sema_.program.types;
  if (types.is_reference(a.type) || types.is_reference(b.type)) {
    note.type = common_reference(a, b);
    note.flex = a.flex == Flex::kNull && b.flex == Flex::kNull ? Flex::kNull : Flex::kNone;
    if (note.type.valid()) return note;
    error(DiagnosticCode::kOperandsDiffer, span,
          "`" + sema_.report.type_text(a.type) + "` and `" + sema_.report.type_text(b.type) +
              "` have no common type");
    return {};
  }
  if (is_flexible_number(a) && is_flexible_number(b)) {
    note.flex = a.flex == Flex::kReal || b.flex == Flex::kReal ? Flex::kReal : Flex::kInteger;
    note.type = note.flex == Flex::kReal
                    ? types.elementary(ir::Kind::kLreal)
                    : common_type(types, a.type, b.type, sema_.options.dialect);
    return note;
  }
  if (is_flexible_number(b)) {
    Note swapped = unify(b, a, span);
    return swapped;
  }
  if (is_flexible_number(a)) {
    Traits other = traits_of(types, b.type);
    if (other.real || (a.flex == Flex::kInteger && (other.integer || other.bits))) {
      note.type = without_range(types, b.type);
      return note;
    }
    if (a.flex == Flex::kInteger && other.boolean) {
      note.type = b.type;
      return note;
    }
    if (a.flex == Flex::kReal && other.integer) {
      note.flex = Flex::kReal;
      bool small = ir::scalar_size(types.scalar(b.type)) <= 2;
      note.type = types.elementary(small ? ir::Kind::kReal : ir::Kind::kLreal);
      return note;
    }
    if (a.flex == Flex::kInteger && other.enumeration && sema_.options.dialect != Dialect::kIec) {
      note.type = types[without_range(types, b.type)].base;
      return note;
    }
  } else if (a.flex == Flex::kEnum && is_enum(types, b.type)) {
    note.type = without_range(types, b.type);
    note.flex = b.flex;
    return note;
  } else if (b.flex == Flex::kEnum && is_enum(types, a.type)) {
    note.type = without_range(types, a.type);
    return note;
  } else if (a.flex == Flex::kText && traits_of(types, b.type).character) {
    note.type = b.type;
    return note;
  } else if (b.flex == Flex::kText && traits_of(types, a.type).character) {
    note.type = a.type;
    return note;
  } else {
    const ir::TypeId first = signed_by_context(types, a, b.type);
    const ir::TypeId second = signed_by_context(types, b, a.type);
    note.type = common_type(types, first, second, sema_.options.dialect);
    if (note.type.valid()) return note;
  }
  error(DiagnosticCode::kOperandsDiffer, span,
        "`" + sema_.report.type_text(a.type) + "` and `" + sema_.report.type_text(b.type) +
            "` have no common type",
        "convert one of them explicitly");
  return {};
}

Note OperatorTypes::infer_binary(const Expr& expr) {
  const Note left = infer(expr.operand);
  const Note right = infer(expr.right);
  if (!left.type.valid() || !right.type.valid()) return {};
  switch (operator_class(expr.binary)) {
    case OperatorClass::kLogical: {
      if (expr.binary == BinaryOp::kAndThen || expr.binary == BinaryOp::kOrElse) {
        allow_extension(operator_text(expr.binary), expr.span, "nest IF statements");
      }
      bool eager = expr.binary == BinaryOp::kAnd || expr.binary == BinaryOp::kOr;
      bool boolean = traits_of(sema_.program.types, right.type).boolean;
      if (eager && boolean && right.can_trap) check_right_operand(*this, expr);
      Note note = infer_bitwise(expr.binary, left, right, expr.span);
      for (const ExprId side : {expr.operand, expr.right})
        note = widened_by(*this, note, side, false);
      return note;
    }
    case OperatorClass::kComparison:
      check_real_equality(*this, expr);
      check_wrapped(*this, expr.operand, "compared");
      check_wrapped(*this, expr.right, "compared");
      return infer_comparison(expr.binary, left, right, expr.span);
    case OperatorClass::kArithmetic: {
      Note note = infer_arithmetic(expr.binary, left, right, expr.span);
      const ir::TypeId unified = note.type;
      for (const ExprId side : {expr.operand, expr.right})
        note = widened_by(*this, note, side, true);
      note.any_sign = has_any_sign(*this, expr, unified, note);
      bool divides = expr.binary == BinaryOp::kDiv || expr.binary == BinaryOp::kMod;
      if (divides && note.type.valid() && right.constant && !left.constant) {
        check_divisor(*this, expr.right, !traits_of(sema_.program.types, note.type).real);
      }
      if (divides) note = quotient_width(sema_, note, expr, left, right);
      if (divides) check_wrapped(*this, expr.operand, "divided");
      if (divides && !right.constant && note.type.valid() &&
          !traits_of(sema_.program.types, note.type).real) {
        note.can_trap = true;
      }
      return note;
    }
  }
  return {};
}

Note OperatorTypes::infer_bitwise(BinaryOp op, const Note& left, const Note& right,
                                  base::SourceSpan span) {
  bool lazy = op == BinaryOp::kAndThen || op == BinaryOp::kOrElse;
  bool address =
      sema_.program.types.is_reference(left.type) || sema_.program.types.is_reference(right.type);
  // Whether a pointer is aligned: the bits of the number that its address is.
  if (address && !lazy && sema_.options.dialect != Dialect::kIec) {
    return infer_pointer_arithmetic(op, left, right, span);
  }
  Note note = unify(left, right, span);
  if (!note.type.valid()) return {};
  Traits traits = traits_of(sema_.program.types, note.type);
  bool integers =
      traits.integer && (sema_.options.dialect != Dialect::kIec || note.flex != Flex::kNone);
  if (traits.boolean || (!lazy && (traits.bits || integers))) {
    const bool wide = left.width == Width::kWide || right.width == Width::kWide;
    if (wide && is_small(sema_, note)) note.width = Width::kWide;
    return note;
  }
  error(DiagnosticCode::kBadOperand, span,
        std::string(operator_text(op)) + " is not defined for `" +
            sema_.report.type_text(note.type) + "`",
        lazy ? "both operands have to be BOOL" : "use BOOL or bit strings");
  return {};
}

Note OperatorTypes::infer_comparison(BinaryOp op, const Note& left, const Note& right,
                                     base::SourceSpan span) {
  Note note = unify(left, right, span);
  if (!note.type.valid()) return {};
  bool scalar = sema_.program.types.is_scalar(note.type);
  if (!scalar && !is_string(sema_.program.types, note.type)) {
    error(DiagnosticCode::kBadOperand, span,
          std::string(operator_text(op)) + " is not defined for `" +
              sema_.report.type_text(note.type) + "`",
          "compare the elements one by one");
    return {};
  }
  note.flex = Flex::kNone;
  note.type = sema_.program.types.elementary(ir::Kind::kBool);
  return note;
}

Note OperatorTypes::infer_arithmetic(BinaryOp op, const Note& left, const Note& right,
                                     base::SourceSpan span) {
  if (sema_.program.types.is_reference(left.type) || sema_.program.types.is_reference(right.type)) {
    return infer_pointer_arithmetic(op, left, right, span);
  }
  Traits a = traits_of(sema_.program.types, left.type);
  Traits b = traits_of(sema_.program.types, right.type);
  if (a.duration || a.date || b.duration || b.date) {
    return infer_time_arithmetic(op, left, right, span);
  }
  if (op == BinaryOp::kPower) {
    // The base decides; an integer base is raised as a real number.
    Note note = merged(left, right);
    note.constant = false;
    note.known = std::min(note.known, Known::kByCall);
    bool real_base = a.real;
    if ((a.number() || a.bits) && (b.number() || b.bits)) {
      note.type = real_base ? without_range(sema_.program.types, left.type)
                            : sema_.program.types.elementary(ir::Kind::kLreal);
      note.flex = real_base ? left.flex : Flex::kReal;
      return note;
    }
  } else {
    Note note = unify(left, right, span);
    if (!note.type.valid()) return {};
    Traits traits = traits_of(sema_.program.types, note.type);
    bool number = traits.number() || (traits.bits && sema_.options.dialect != Dialect::kIec);
    const bool of_enumeration = traits.enumeration && sema_.options.dialect != Dialect::kIec;
    if (of_enumeration) {
      note.type = sema_.program.types[without_range(sema_.program.types, note.type)].base;
    }
    if (of_enumeration || (number && !(op == BinaryOp::kMod && traits.real))) {
      note.width = width_of(sema_, note, op != BinaryOp::kDiv && op != BinaryOp::kMod);
      return note;
    }
  }
  report_not_defined(op, left, right, span);
  return {};
}

void OperatorTypes::report_not_defined(BinaryOp op, const Note& left, const Note& right,
                                       base::SourceSpan span) {
  error(DiagnosticCode::kBadOperand, span,
        std::string(operator_text(op)) + " is not defined for `" +
            sema_.report.type_text(left.type) + "` and `" + sema_.report.type_text(right.type) +
            "`");
}

// IEC table 30: durations with durations and numbers, points in time with durations,
// and the distance of two points of one kind.
Note OperatorTypes::infer_time_arithmetic(BinaryOp op, const Note& left, const Note& right,
                                          base::SourceSpan span) {
  Note note = merged(left, right);
  const ir::TypeTable& types = sema_.program.types;
  Traits a = traits_of(types, left.type);
  Traits b = traits_of(types, right.type);
  bool sum = op == BinaryOp::kAdd || op == BinaryOp::kSub;
  if (a.duration && b.duration && sum) {
    note.type = common_type(types, left.type, right.type, sema_.options.dialect);
    return note;
  }
  if (a.date && b.duration && sum && types.root_kind(left.type) != ir::Kind::kDate &&
      types.root_kind(left.type) != ir::Kind::kLdate) {
    note.type = without_range(types, left.type);
    return note;
  }
  if (a.date && b.date && op == BinaryOp::kSub) {
    ir::TypeId common = common_type(types, left.type, right.type, sema_.options.dialect);
    if (common.valid()) {
      note.type = types.elementary(is_long_time(types.root_kind(common)) ? ir::Kind::kLtime
                                                                         : ir::Kind::kTime);
      return note;
    }
  }
  if (a.duration && b.number() && (op == BinaryOp::kMul || op == BinaryOp::kDiv)) {
    note.type = without_range(types, left.type);
    return note;
  }
  if (a.number() && b.duration && op == BinaryOp::kMul) {
    note.type = without_range(types, right.type);
    return note;
  }
  report_not_defined(op, left, right, span);
  return {};
}

}  // namespace frontend
