#include "frontend/sema/expressions/width.h"

#include <algorithm>

#include "frontend/sema/constants/constants.h"
#include "frontend/sema/phase.h"
#include "frontend/sema/types/conversion.h"

namespace frontend {

bool is_small(const Sema& sema, const Note& note) {
  if (note.flex != Flex::kNone || !note.type.valid()) return false;
  const ir::TypeTable& types = sema.program.types;
  const Traits traits = traits_of(types, note.type);
  return (traits.integer || traits.bits) && ir::scalar_size(types.scalar(note.type)) < 4;
}

Width width_of(const Sema& sema, const Note& note, bool can_grow) {
  if (!is_small(sema, note)) return Width::kOwn;
  if (sema.options.dialect != Dialect::kIec) return Width::kWide;
  return can_grow ? Width::kWraps : Width::kOwn;
}

ir::TypeId computed_type(const Sema& sema, const Note& note) {
  if (note.width != Width::kWide) return note.type;
  return sema.program.types.elementary(ir::Kind::kDint);
}

namespace {

// Not SINT#-1, and not SINT#16#FF either.
bool is_positive_literal(const Sema& sema, const Expr& expr, ir::Scalar scalar) {
  if (expr.kind != ExprKind::kLiteral) return false;
  const Literal& literal = sema.tree.literals[expr.number];
  return !literal.negative && static_cast<Wide>(literal.integer) <= limits_of(scalar).high;
}

}  // namespace

Note quotient_width(const Sema& sema, Note note, const Expr& expr, const Note& left,
                    const Note& right) {
  if (note.width != Width::kWide || left.width == Width::kWide || right.width == Width::kWide) {
    return note;
  }
  const ir::Scalar scalar = sema.program.types.scalar(note.type);
  const bool fits = expr.binary == BinaryOp::kMod || !ir::is_signed(scalar) ||
                    is_positive_literal(sema, sema.tree[expr.right], scalar);
  if (fits) note.width = Width::kOwn;
  return note;
}

// Of MOVE, SEL, MUX, MAX and their kin.
static Width width_of_choice(const Phase& phase, const stdlib::FunctionRow& row,
                             const std::vector<ExprId>& args) {
  if (has_wide(phase, args)) return Width::kWide;
  const bool chooses =
      row.rule == stdlib::FunctionRule::kSelect || row.rule == stdlib::FunctionRule::kMux;
  const bool wraps = std::any_of(args.begin() + (chooses ? 1 : 0), args.end(),
                                 [&](ExprId id) { return phase.infer(id).width == Width::kWraps; });
  return wraps ? Width::kWraps : Width::kOwn;
}

Width standard_width(const Phase& phase, const stdlib::FunctionRow& row,
                     const std::vector<ExprId>& args, const Note& note, bool typed) {
  using stdlib::FunctionRule;
  if (typed) return Width::kOwn;  // MAX_INT
  switch (row.rule) {
    case FunctionRule::kArithmetic:
    case FunctionRule::kBitwise:
      return note.width;
    case FunctionRule::kNumberSame:
      if (phase.infer(args[0]).width == Width::kWraps) return Width::kWraps;
      return width_of(phase.sema(), note, false);
    case FunctionRule::kMove:
    case FunctionRule::kSelect:
    case FunctionRule::kMux:
    case FunctionRule::kExtreme:
      return is_small(phase.sema(), note) ? width_of_choice(phase, row, args) : Width::kOwn;
    case FunctionRule::kReal:
    case FunctionRule::kTrunc:
    case FunctionRule::kShift:
    case FunctionRule::kNot:
    case FunctionRule::kCompare:
    case FunctionRule::kString:
    case FunctionRule::kStringNumber:
    case FunctionRule::kClock:
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
    case FunctionRule::kMoment:
    case FunctionRule::kSplit:
    case FunctionRule::kWeekday:
    case FunctionRule::kByteOrder:
    case FunctionRule::kValid:
      return Width::kOwn;
  }
  return Width::kOwn;
}

bool has_wide(const Phase& phase, const std::vector<ExprId>& operands) {
  return std::any_of(operands.begin(), operands.end(),
                     [&](ExprId id) { return phase.infer(id).width == Width::kWide; });
}

ir::TypeId compared_type(const Phase& phase, ir::TypeId common,
                         const std::vector<ExprId>& operands) {
  Note meeting;
  meeting.type = common;
  const bool wide = is_small(phase.sema(), meeting) && has_wide(phase, operands);
  return wide ? phase.sema().program.types.elementary(ir::Kind::kDint) : common;
}

namespace {

// An integer without a type.
std::optional<Constant> bare_literal(const Phase& phase, ExprId id) {
  const Note& note = phase.infer(id);
  if (!note.constant || note.flex != Flex::kInteger) return std::nullopt;
  auto value = phase.ask<Constants>().fold(id, {});
  return value && value->form == Constant::Form::kInteger ? value : std::nullopt;
}

}  // namespace

ir::TypeId compared_with_literals(const Phase& phase, ir::TypeId compared,
                                  const std::vector<ExprId>& operands) {
  const ir::TypeTable& types = phase.sema().program.types;
  if (phase.sema().options.dialect == Dialect::kIec || !types.is_scalar(compared)) return compared;
  const Traits traits = traits_of(types, compared);
  const uint32_t size = ir::scalar_size(types.scalar(compared));
  if ((!traits.integer && !traits.bits) || size == 8) return compared;
  const bool is_signed = ir::is_signed(types.scalar(compared));
  ir::TypeId out = compared;
  for (const ExprId id : operands) {
    const auto value = bare_literal(phase, id);
    if (!value || phase.ask<Constants>().fits(*value, compared)) continue;
    if (value->integer < 0 && size == 4 && !is_signed) return compared;  // -1 may be all bits
    const auto within = [&](ir::Scalar scalar) {
      const Limits limits = limits_of(scalar);
      return value->integer >= limits.low && value->integer <= limits.high;
    };
    if (size < 4 && within(ir::Scalar::kI32)) {
      if (out == compared) out = types.elementary(ir::Kind::kDint);
    } else if (within(ir::Scalar::kI64)) {
      out = types.elementary(ir::Kind::kLint);
    } else {
      return compared;
    }
  }
  return out;
}

Note widened_by(const Sema& sema, Note note, ExprId operand) {
  const Expr* expr = &sema.tree[operand];
  const bool negative = note.width == Width::kWraps && expr->kind == ExprKind::kUnary &&
                        expr->unary == UnaryOp::kNegate;
  if (negative) expr = &sema.tree[expr->operand];
  if (note.width == Width::kOwn || expr->kind != ExprKind::kLiteral) return note;
  const Literal& literal = sema.tree.literals[expr->number];
  if (literal.kind != LiteralKind::kInteger || literal.prefix != kNoNumber) return note;
  const ir::TypeTable& types = sema.program.types;
  const auto value = static_cast<Wide>(literal.integer);
  const Limits limits = limits_of(types.scalar(note.type));
  if (negative ? -value >= limits.low : value <= limits.high) return note;
  const Wide dint = limits_of(ir::Scalar::kI32).high;
  const Wide lint = limits_of(ir::Scalar::kI64).high;
  note.type = types.elementary(value <= dint   ? ir::Kind::kDint
                               : value <= lint ? ir::Kind::kLint
                                               : ir::Kind::kUlint);
  note.width = Width::kOwn;
  return note;
}

bool wraps_outside(const Sema& sema, const Note& note, const Expr& index, const Note& left,
                   Limits bounds) {
  const bool sum = index.kind == ExprKind::kBinary && note.width == Width::kWide &&
                   (index.binary == BinaryOp::kAdd || index.binary == BinaryOp::kSub);
  const ir::TypeTable& types = sema.program.types;
  if (!sum || left.width == Width::kWide || left.flex != Flex::kNone ||
      without_range(types, left.type) != note.type) {
    return false;
  }
  const Expr& right = sema.tree[index.right];
  if (right.kind != ExprKind::kLiteral) return false;
  const Literal& literal = sema.tree.literals[right.number];
  if (literal.kind != LiteralKind::kInteger || literal.prefix != kNoNumber) return false;
  const Limits own = limits_of(types.scalar(note.type));
  const auto by = static_cast<Wide>(literal.integer);
  return index.binary == BinaryOp::kAdd ? own.low + by <= bounds.low : own.high - by >= bounds.high;
}

std::optional<uint64_t> cut_to(const Sema& sema, const Constant& value, const Note& note,
                               ir::TypeId target) {
  const ir::TypeTable& types = sema.program.types;
  if (note.width != Width::kWide || value.form != Constant::Form::kInteger) return std::nullopt;
  if (types[target].kind == ir::Kind::kSubrange) return std::nullopt;
  const Traits to = traits_of(types, target);
  const bool fits = (to.integer || to.bits) &&
                    implicit_fit(types, note.type, target, sema.options.dialect) != Fit::kNone;
  if (!fits) return std::nullopt;
  return static_cast<uint64_t>(wrap_to(types.scalar(target), value.integer));
}

}  // namespace frontend
