// Constants meet the type of their place: what fits is taken, what does not is an error.
#include <bit>
#include <cmath>
#include <cstdio>

#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/width.h"
#include "frontend/sema/sema.h"
#include "ir/types/utf.h"

namespace frontend {
namespace {

// As it is written in a source.
std::string literal_text(const Constant& value, bool wide) {
  if (!wide) return "'" + value.text + "'";
  std::string out;
  for (size_t i = 0; i + 1 < value.text.size(); i += 2) {
    uint32_t code = static_cast<uint8_t>(value.text[i]);
    code |= uint32_t{static_cast<uint8_t>(value.text[i + 1])} << 8;
    out += ir::utf8(code);
  }
  return '"' + out + '"';
}

std::string value_text(const Constant& value, const ir::TypeTable& types) {
  if (value.flex == Flex::kNull) return "NULL";
  if (value.form == Constant::Form::kReal) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value.real);
    return text;
  }
  if (value.form == Constant::Form::kText) {
    return literal_text(value, value.type.valid() && types[value.type].kind == ir::Kind::kWstring);
  }
  return wide_text(value.integer);
}

uint64_t real_bits(ir::Scalar scalar, double value) {
  if (scalar == ir::Scalar::kF32) return std::bit_cast<uint32_t>(static_cast<float>(value));
  return std::bit_cast<uint64_t>(value);
}

}  // namespace

std::optional<uint64_t> Constants::fit(const Constant& value, ir::TypeId target,
                                       base::SourceSpan span) {
  const ir::TypeTable& types = sema_.program.types;
  Traits to = traits_of(types, target);
  auto mismatch = [&]() -> std::optional<uint64_t> {
    std::string what = value.flex == Flex::kNone ? "`" + sema_.report.type_text(value.type) + "`"
                                                 : value_text(value, types);
    error(DiagnosticCode::kTypeMismatch, span,
          what + " does not go with `" + sema_.report.type_text(target) + "`");
    return std::nullopt;
  };
  if (value.flex == Flex::kNull) {
    if (types.is_reference(target) || takes_null(target)) return 0;
    error(DiagnosticCode::kTypeMismatch, span,
          "NULL does not go with `" + sema_.report.type_text(target) + "`",
          "it is for pointers, references and interfaces");
    return std::nullopt;
  }
  if (!types.is_scalar(target)) return mismatch();
  ir::Scalar scalar = types.scalar(target);
  if (value.form == Constant::Form::kText) {
    uint32_t width = scalar == ir::Scalar::kU16 ? 2 : 1;
    bool wide = types[value.type].kind == ir::Kind::kWstring;
    if (!to.character || wide != (width == 2) || value.text.size() != width) return mismatch();
    uint64_t low = static_cast<uint8_t>(value.text[0]);
    return width == 1 ? low : low | uint64_t{static_cast<uint8_t>(value.text[1])} << 8;
  }
  bool typed = value.flex == Flex::kNone;
  bool same = typed && without_range(types, value.type) == without_range(types, target);
  if (typed && !same &&
      implicit_fit(types, value.type, target, sema_.options.dialect) == Fit::kNone) {
    return mismatch();
  }
  const bool narrows = typed && value.literal && sema_.options.dialect == Dialect::kIec &&
                       implicit_fit(types, value.type, target, Dialect::kIec) == Fit::kNarrowing;
  if (narrows && !allow_narrowing(value.type, target, span)) return std::nullopt;
  if (value.flex == Flex::kEnum && !is_enum(types, target)) return mismatch();
  if (!typed && value.flex != Flex::kEnum) {
    bool enumeration = to.enumeration && sema_.options.dialect != Dialect::kIec;
    bool bit = to.boolean && (value.integer == 0 || value.integer == 1);
    bool number = to.number() || to.bits || enumeration || bit;
    if (!number || (value.form == Constant::Form::kReal && !to.real)) {
      if (value.form != Constant::Form::kReal || !to.integer) return mismatch();
    }
  }
  if (to.real) {
    double real =
        value.form == Constant::Form::kReal ? value.real : static_cast<double>(value.integer);
    bool overflow = scalar == ir::Scalar::kF32 && std::isfinite(real) &&
                    !std::isfinite(static_cast<float>(real));
    if (!overflow) return real_bits(scalar, real);
    error(DiagnosticCode::kLiteralOutOfRange, span,
          value_text(value, types) + " is too large for `" + sema_.report.type_text(target) + "`");
    return std::nullopt;
  }
  Wide integer = value.integer;
  if (value.form == Constant::Form::kReal) {
    if (!allow_narrowing(typed ? value.type : types.elementary(ir::Kind::kLreal), target, span)) {
      return std::nullopt;
    }
    double rounded = std::nearbyint(value.real);
    integer = std::fabs(rounded) < 1e19 ? static_cast<Wide>(rounded) : static_cast<Wide>(1) << 100;
  }
  Limits limits = limits_of(scalar);
  if (types[target].kind == ir::Kind::kSubrange) limits = {types[target].low, types[target].high};
  if (integer >= limits.low && integer <= limits.high) return static_cast<uint64_t>(integer);
  if (auto bits = same_bits(value, integer, target, span)) return bits;
  error(DiagnosticCode::kLiteralOutOfRange, span,
        wide_text(integer) + " does not fit into `" + sema_.report.type_text(target) + "`",
        "it holds " + wide_text(limits.low) + ".." + wide_text(limits.high));
  return std::nullopt;
}

bool Constants::takes_null(ir::TypeId target) const {
  const ir::TypeTable& types = sema_.program.types;
  const Traits traits = traits_of(types, target);
  const bool number = (traits.integer || traits.bits) && ir::scalar_size(types.scalar(target)) >= 4;
  return is_interface(types, target) || (number && sema_.options.dialect != Dialect::kIec);
}

bool Constants::fits(const Constant& value, ir::TypeId target) const {
  const Limits limits = limits_of(sema_.program.types.scalar(target));
  const bool inside = value.integer >= limits.low && value.integer <= limits.high;
  return inside || has_same_bits(value, value.integer, target);
}

bool Constants::has_same_bits(const Constant& value, Wide integer, ir::TypeId target) const {
  const Traits to = traits_of(sema_.program.types, target);
  if (sema_.options.dialect == Dialect::kIec || value.form != Constant::Form::kInteger ||
      sema_.program.types[target].kind == ir::Kind::kSubrange) {
    return false;
  }
  const ir::Scalar scalar = sema_.program.types.scalar(target);
  const Wide span_of_bits = static_cast<Wide>(1) << (ir::scalar_size(scalar) * 8);
  const bool pattern =
      value.pattern || (value.type.valid() && traits_of(sema_.program.types, value.type).bits);
  const bool into_signed =
      to.integer && ir::is_signed(scalar) && pattern && integer > 0 && integer < span_of_bits;
  return into_signed || (to.bits && integer < 0 && integer >= -span_of_bits / 2);
}

std::optional<uint64_t> Constants::same_bits(const Constant& value, Wide integer, ir::TypeId target,
                                             base::SourceSpan span) {
  if (!has_same_bits(value, integer, target)) return std::nullopt;
  const Wide wrapped = wrap_to(sema_.program.types.scalar(target), integer);
  warning(DiagnosticCode::kSignChanged, span,
          wide_text(integer) + " becomes " + wide_text(wrapped) + " in `" +
              sema_.report.type_text(target) + "`",
          integer < 0 ? "write the bits, for example with 16#" : "write the number");
  return static_cast<uint64_t>(wrapped);
}

std::optional<std::string> Constants::fit_text(const Constant& value, ir::TypeId target,
                                               base::SourceSpan span) {
  const ir::Type& type = sema_.program.types[target];
  bool wide = type.kind == ir::Kind::kWstring;
  bool text = value.form == Constant::Form::kText &&
              (sema_.program.types[value.type].kind == ir::Kind::kWstring) == wide;
  if (!text) {
    error(DiagnosticCode::kTypeMismatch, span,
          value_text(value, sema_.program.types) + " does not go with `" +
              sema_.report.type_text(target) + "`",
          wide ? "write WSTRING literals in double quotes"
               : "write STRING literals in single quotes");
    return std::nullopt;
  }
  size_t room = size_t{type.capacity} * (wide ? 2 : 1);
  if (value.text.size() <= room) return value.text;
  warning(DiagnosticCode::kStringTruncated, span,
          std::to_string(value.text.size() / (wide ? 2 : 1)) + " characters for `" +
              sema_.report.type_text(target) + "`; the rest is cut off");
  return value.text.substr(0, room);
}

std::optional<uint64_t> Constants::fold_bits(ExprId expr, ir::TypeId target, Known least) {
  auto value = fold(expr, target, least);
  if (!value) return std::nullopt;
  if (const auto cut = cut_to(sema_, *value, infer(expr), target)) return cut;
  return fit(*value, target, sema_.tree[expr].span);
}

std::optional<int64_t> Constants::fold_integer(ExprId expr) {
  auto value = fold(expr, {});
  if (!value) return std::nullopt;
  bool integer = value->form == Constant::Form::kInteger;
  if (integer && value->type.valid()) {
    Traits traits = traits_of(sema_.program.types, value->type);
    integer = traits.integer || traits.bits || traits.enumeration;
  }
  if (!integer) {
    error(DiagnosticCode::kTypeMismatch, sema_.tree[expr].span, "an integer is needed here");
    return std::nullopt;
  }
  Limits limits = limits_of(ir::Scalar::kI64);
  if (value->integer > limits.high || value->integer < limits.low) {
    error(DiagnosticCode::kLiteralOutOfRange, sema_.tree[expr].span,
          wide_text(value->integer) + " is too large here");
    return std::nullopt;
  }
  return static_cast<int64_t>(value->integer);
}

}  // namespace frontend
