// Conversions. Implicit ones are lossless or reported; explicit ones follow
// docs/LANGUAGE.md: reals round half to even and trap when out of range,
// integers keep their low bits, times count in the unit of their type.
#include "frontend/lower/conversions.h"
#include "frontend/lower/references.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/expressions/width.h"
#include "ir/types/time_units.h"

namespace frontend {
namespace {

// Nanoseconds per unit in conversions to and from numbers.
int64_t unit_of(ir::Kind kind) {
  switch (kind) {
    case ir::Kind::kTime:
    case ir::Kind::kTod:
      return ir::kNsPerMillisecond;
    case ir::Kind::kDate:
    case ir::Kind::kDt:
      return ir::kNsPerSecond;
    default:
      return 1;
  }
}

bool is_time(const ir::TypeTable& types, ir::TypeId type) {
  Traits traits = traits_of(types, type);
  return traits.duration || traits.date;
}

uint64_t double_bits(double value) {
  uint64_t bits;
  static_assert(sizeof bits == sizeof value);
  __builtin_memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

ir::ValueId ValueCode::machine_convert(ir::ValueId value, ir::Scalar from, ir::Scalar to,
                                       bool truncate) {
  if (from == to) return value;
  if (to == ir::Scalar::kBool) {
    if (!ir::is_float(from)) return build_.unary(ir::Op::kToBool, to, value);
    return build_.compare(ir::Op::kNe, from, value, build_.constant(from, 0));
  }
  if (ir::is_float(to)) {
    if (from == ir::Scalar::kBool) value = build_.unary(ir::Op::kWrap, ir::Scalar::kU8, value);
    return build_.unary(ir::Op::kToFloat, to, value);
  }
  if (ir::is_float(from)) {
    return build_.unary(truncate ? ir::Op::kTrunc : ir::Op::kRound, to, value);
  }
  return build_.unary(ir::Op::kWrap, to, value);
}

// Implicit: what the context needs from what is there.
ir::ValueId Conversions::convert(Typed from, ir::TypeId to, base::SourceSpan span) {
  if (types().is_reference(from.type) || types().is_reference(to)) {
    return ask<References>().convert_reference(from, to, span);
  }
  if (!fits(from.type, to, span)) return code_.zero(to);
  ir::ValueId out = code_.machine_convert(from.value, scalar(from.type), scalar(to));
  return code_.check_range(out, from.type, to);
}

bool Conversions::fits(ir::TypeId from, ir::TypeId to, base::SourceSpan span) {
  switch (implicit_fit(types(), from, to, sema_.options.dialect)) {
    case Fit::kNone:
      error(DiagnosticCode::kTypeMismatch, span,
            "`" + sema_.report.type_text(from) + "` does not go with `" +
                sema_.report.type_text(to) + "`",
            sema_.report.conversion_fix(to));
      return false;
    case Fit::kNarrowing:
      return allow_narrowing(from, to, span);
    case Fit::kSame:
    case Fit::kLossless:
      break;
  }
  return true;
}

ir::ValueId ValueCode::check_range(ir::ValueId value, ir::TypeId from, ir::TypeId to) {
  const ir::Type& range = types()[to];
  if (range.kind != ir::Kind::kSubrange) return value;
  const ir::Type& source = types()[from];
  if (source.kind == ir::Kind::kSubrange && source.low >= range.low && source.high <= range.high) {
    return value;
  }
  return build_.check_range(scalar(to), value, range.low, range.high);
}

namespace {

// Table 25 of edition 3: between reals and bit strings of their size the bits stay. CODESYS
// sources expect the number there.
bool is_binary_transfer(const ir::TypeTable& types, ir::TypeId from, ir::TypeId to) {
  Traits source = traits_of(types, from);
  Traits target = traits_of(types, to);
  bool between = (source.real && target.bits) || (source.bits && target.real);
  return between && ir::scalar_size(types.scalar(from)) == ir::scalar_size(types.scalar(to));
}

}  // namespace

ir::ValueId ValueCode::explicit_conversion(Typed from, ir::TypeId to, bool truncate) {
  bool time_source = is_time(types(), from.type);
  bool time_target = is_time(types(), to);
  if (time_source && time_target) return time_to_time(from, to);
  if (time_source) return from_time(from, to);
  if (time_target) return to_time(from, to);
  if (types().root_kind(from.type) == ir::Kind::kWchar &&
      types().root_kind(to) == ir::Kind::kChar) {
    return narrow_character(from.value);
  }
  if (dialect_ == Dialect::kIec && is_binary_transfer(types(), from.type, to)) {
    return build_.unary(ir::Op::kBits, scalar(to), from.value);
  }
  return machine_convert(from.value, scalar(from.type), scalar(to), truncate);
}

ir::ValueId ValueCode::from_time(Typed from, ir::TypeId to) {
  int64_t unit = unit_of(types().root_kind(from.type));
  ir::Scalar machine = scalar(to);
  if (ir::is_float(machine)) {
    ir::ValueId real = build_.unary(ir::Op::kToFloat, ir::Scalar::kF64, from.value);
    ir::ValueId divisor = build_.constant(ir::Scalar::kF64, double_bits(static_cast<double>(unit)));
    real = build_.binary(ir::Op::kDiv, ir::Scalar::kF64, real, divisor);
    return machine_convert(real, ir::Scalar::kF64, machine);
  }
  ir::ValueId count = from.value;
  if (unit != 1 && machine != ir::Scalar::kBool) {
    ir::ValueId divisor = build_.constant(ir::Scalar::kI64, static_cast<uint64_t>(unit));
    count = build_.binary(ir::Op::kDiv, ir::Scalar::kI64, count, divisor);
  }
  return machine_convert(count, ir::Scalar::kI64, machine);
}

ir::ValueId ValueCode::to_time(Typed from, ir::TypeId to) {
  int64_t unit = unit_of(types().root_kind(to));
  const bool of_day = is_time_of_day(types(), to);
  ir::Scalar machine = scalar(from.type);
  if (ir::is_float(machine)) {
    ir::ValueId real = machine_convert(from.value, machine, ir::Scalar::kF64);
    ir::ValueId factor = build_.constant(ir::Scalar::kF64, double_bits(static_cast<double>(unit)));
    real = build_.binary(ir::Op::kMul, ir::Scalar::kF64, real, factor);
    const ir::ValueId whole = build_.unary(ir::Op::kRound, ir::Scalar::kI64, real);
    return of_day ? floor_modulo(whole, ir::kNsPerDay) : whole;
  }
  ir::ValueId count = machine_convert(from.value, machine, ir::Scalar::kI64);
  if (of_day) count = floor_modulo(count, ir::kNsPerDay / unit);
  if (unit == 1) return count;
  ir::ValueId factor = build_.constant(ir::Scalar::kI64, static_cast<uint64_t>(unit));
  return build_.binary(ir::Op::kMul, ir::Scalar::kI64, count, factor);
}

// Never negative, so that moments before 1970 belong to their own day.
ir::ValueId ValueCode::floor_modulo(ir::ValueId value, int64_t divisor) {
  constexpr ir::Scalar kI64 = ir::Scalar::kI64;
  ir::ValueId by = build_.constant(kI64, static_cast<uint64_t>(divisor));
  ir::ValueId rest = build_.binary(ir::Op::kMod, kI64, value, by);
  ir::ValueId raised = build_.binary(ir::Op::kAdd, kI64, rest, by);
  ir::ValueId negative = build_.compare(ir::Op::kLt, kI64, rest, build_.constant(kI64, 0));
  return build_.select(kI64, negative, rest, raised);
}

ir::ValueId ValueCode::time_to_time(Typed from, ir::TypeId to) {
  ir::Kind source = types().root_kind(from.type);
  ir::Kind target = types().root_kind(to);
  bool to_date = target == ir::Kind::kDate || target == ir::Kind::kLdate;
  bool to_tod = target == ir::Kind::kTod || target == ir::Kind::kLtod;
  bool is_tod = source == ir::Kind::kTod || source == ir::Kind::kLtod;
  bool is_date = source == ir::Kind::kDate || source == ir::Kind::kLdate;
  if (to_tod && !is_tod) return floor_modulo(from.value, ir::kNsPerDay);
  if (to_date && !is_date) {
    ir::ValueId rest = floor_modulo(from.value, ir::kNsPerDay);
    return build_.binary(ir::Op::kSub, ir::Scalar::kI64, from.value, rest);
  }
  return from.value;
}

ir::ValueId Conversions::emit_conversion(const Expr& expr, const Conversion& conversion) {
  ExprId argument = ask<Calls>().conversion_argument(expr);
  ir::TypeId to = elementary(conversion.to);
  const Note& note = infer(argument);
  bool named = !conversion.any_source && ir::is_elementary(conversion.from);
  if (is_string(types(), note.type) && !named) return from_string(argument, to);
  // TO_DINT(a * b) converts what was computed, INT_TO_DINT takes an INT.
  const ir::TypeId given = computed_type(sema_, note);
  ir::TypeId from = without_range(types(), named ? elementary(conversion.from) : given);
  ir::ValueId source = value(argument, from);
  set_line(expr.span);
  if (conversion.bcd == Conversion::Bcd::kFrom) {
    // BCD_TO_INT is a function of CODESYS' library Util: -1 for what is no BCD.
    const bool of_util = !named && conversion.to == ir::Kind::kInt;
    return code_.from_bcd({source, from}, to, of_util && sema_.options.dialect != Dialect::kIec);
  }
  if (conversion.bcd == Conversion::Bcd::kTo) return code_.to_bcd({source, from}, to);
  return code_.explicit_conversion({source, from}, to, conversion.truncate);
}

// What Latin-1 lacks becomes a question mark, as in strings.
ir::ValueId ValueCode::narrow_character(ir::ValueId wide_character) {
  constexpr ir::Scalar kU16 = ir::Scalar::kU16;
  ir::ValueId most = build_.constant(kU16, 0xFF);
  ir::ValueId fits = build_.compare(ir::Op::kLe, kU16, wide_character, most);
  ir::ValueId out = build_.select(kU16, fits, build_.constant(kU16, '?'), wide_character);
  return build_.unary(ir::Op::kWrap, ir::Scalar::kU8, out);
}

}  // namespace frontend
