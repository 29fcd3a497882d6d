#include "frontend/sema/expressions/width.h"

#include <algorithm>

#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/value_range.h"
#include "frontend/sema/phase.h"
#include "frontend/sema/types/conversion.h"

namespace frontend {

static uint32_t bytes_of_number(const Sema& sema, const Note& note) {
  if (note.flex != Flex::kNone || !note.type.valid()) return 0;
  const ir::TypeTable& types = sema.program.types;
  const Traits traits = traits_of(types, note.type);
  return traits.integer || traits.bits ? ir::scalar_size(types.scalar(note.type)) : 0;
}

bool is_small(const Sema& sema, const Note& note) {
  const uint32_t bytes = bytes_of_number(sema, note);
  return bytes != 0 && bytes < 4;
}

bool has_wider(const Sema& sema, const Note& note) {
  const uint32_t bytes = bytes_of_number(sema, note);
  return bytes != 0 && bytes < 8;
}

Width width_of(const Sema& sema, const Note& note, bool can_grow) {
  const bool iec = sema.options.dialect == Dialect::kIec;
  if (iec) return can_grow && has_wider(sema, note) ? Width::kWraps : Width::kOwn;
  return is_small(sema, note) ? Width::kWide : Width::kOwn;
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
                             const std::vector<ExprId>& args, const Note& note) {
  if (phase.sema().options.dialect != Dialect::kIec)
    return is_small(phase.sema(), note) && has_wide(phase, args) ? Width::kWide : Width::kOwn;
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
      return has_wider(phase.sema(), note) ? width_of_choice(phase, row, args, note) : Width::kOwn;
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
  ir::TypeId out = compared;
  for (const ExprId id : operands) {
    const auto value = bare_literal(phase, id);
    // A small bit string is never below 0; -1 may be all bits of a DWORD, which has no DINT.
    const bool below = value && value->integer < 0 && size < 4 && traits.bits;
    if (!value || (!below && phase.ask<Constants>().fits(*value, compared))) continue;
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

namespace {

bool holds(ir::Scalar scalar, Wide value) {
  const Limits limits = limits_of(scalar);
  return value >= limits.low && value <= limits.high;
}

// The first of `kinds` that holds the literal and all that `own` does.
ir::TypeId first_holding(const ir::TypeTable& types, std::initializer_list<ir::Kind> kinds,
                         Wide literal, ir::Scalar own) {
  const Limits limits = limits_of(own);
  for (const ir::Kind kind : kinds) {
    const ir::TypeId type = types.elementary(kind);
    const ir::Scalar scalar = types.scalar(type);
    const bool both = holds(scalar, literal) && holds(scalar, limits.low);
    if (both && holds(scalar, limits.high)) return type;
  }
  return {};
}

// Invalid: there is none.
ir::TypeId type_with_literal(const ir::TypeTable& types, ir::TypeId own, Wide literal,
                             bool arithmetic) {
  using ir::Kind;
  const ir::Scalar scalar = types.scalar(own);
  if (arithmetic) {
    return first_holding(types, {Kind::kDint, Kind::kLint, Kind::kUlint}, literal, scalar);
  }
  if (traits_of(types, own).bits) {
    return first_holding(types, {Kind::kWord, Kind::kDword, Kind::kLword}, literal, scalar);
  }
  if (!ir::is_signed(scalar) && literal >= 0) {
    return first_holding(types, {Kind::kUint, Kind::kUdint, Kind::kUlint}, literal, scalar);
  }
  return first_holding(types, {Kind::kInt, Kind::kDint, Kind::kLint}, literal, scalar);
}

bool is_never_negative(const Phase& phase, ExprId id) {
  return phase.infer(id).any_sign || is_natural(phase, id);
}

}  // namespace

Note widened_by(const Phase& phase, Note note, ExprId operand, bool arithmetic) {
  const ir::TypeTable& types = phase.sema().program.types;
  if (note.flex != Flex::kNone || !note.type.valid() || !types.is_scalar(note.type)) return note;
  const Traits traits = traits_of(types, note.type);
  if (!traits.integer && !traits.bits) return note;
  const auto value = bare_literal(phase, operand);
  if (!value || holds(types.scalar(note.type), value->integer)) return note;
  const bool computed_as_dint = note.width == Width::kWide;
  if (arithmetic && computed_as_dint && value->integer < 0 &&
      holds(ir::Scalar::kI32, value->integer)) {
    return note;
  }
  const bool grows = arithmetic && note.width != Width::kOwn;
  if (!grows && phase.ask<Constants>().fits(*value, note.type)) return note;  // as bits
  const ir::TypeId wider = type_with_literal(types, note.type, value->integer, arithmetic);
  if (!wider.valid()) return note;
  note.type = wider;
  const bool stays_wide = computed_as_dint && !arithmetic && is_small(phase.sema(), note);
  const bool wraps = note.width == Width::kWraps && has_wider(phase.sema(), note);
  note.width = stays_wide ? Width::kWide : wraps ? Width::kWraps : Width::kOwn;
  return note;
}

bool has_any_sign(const Phase& phase, const Expr& expr, ir::TypeId unified, const Note& note) {
  const ir::TypeTable& types = phase.sema().program.types;
  if (note.flex != Flex::kNone || !note.type.valid() || expr.binary == BinaryOp::kSub) return false;
  const Note& left = phase.infer(expr.operand);
  const Note& right = phase.infer(expr.right);
  if (note.type == unified && !left.any_sign && !right.any_sign) return false;
  const bool whole =
      types[note.type].kind == ir::Kind::kDint || types[note.type].kind == ir::Kind::kLint;
  return whole && is_never_negative(phase, expr.operand) && is_never_negative(phase, expr.right);
}

ir::TypeId signed_by_context(const ir::TypeTable& types, const Note& note, ir::TypeId target) {
  if (!note.any_sign || !target.valid() || !types.is_scalar(target)) return note.type;
  const Traits traits = traits_of(types, target);
  const uint32_t size = ir::scalar_size(types.scalar(note.type));
  const bool takes = (traits.integer || traits.bits) && !ir::is_signed(types.scalar(target)) &&
                     ir::scalar_size(types.scalar(target)) >= size;
  if (!takes) return note.type;
  return types.elementary(size == 4 ? ir::Kind::kUdint : ir::Kind::kUlint);
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
