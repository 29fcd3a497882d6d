// Conversions between strings and everything else: native functions do the work.
#include "frontend/lower/body.h"

namespace frontend {
namespace {

using stdlib::NativeId;

constexpr uint32_t kNumberText = 80;  // longer than any number, time or date

struct TextForm {
  NativeId native;
  ir::Scalar machine;
};

std::optional<TextForm> text_form(ir::Kind kind, ir::Scalar machine) {
  switch (kind) {
    case ir::Kind::kBool:
      return TextForm{NativeId::kBoolToString, ir::Scalar::kBool};
    case ir::Kind::kReal:
      return TextForm{NativeId::kF32ToString, ir::Scalar::kF32};
    case ir::Kind::kLreal:
      return TextForm{NativeId::kF64ToString, ir::Scalar::kF64};
    case ir::Kind::kTime:
    case ir::Kind::kLtime:
      return TextForm{NativeId::kTimeToString, ir::Scalar::kI64};
    case ir::Kind::kDate:
    case ir::Kind::kLdate:
      return TextForm{NativeId::kDateToString, ir::Scalar::kI64};
    case ir::Kind::kTod:
    case ir::Kind::kLtod:
      return TextForm{NativeId::kTodToString, ir::Scalar::kI64};
    case ir::Kind::kDt:
    case ir::Kind::kLdt:
      return TextForm{NativeId::kDtToString, ir::Scalar::kI64};
    case ir::Kind::kChar:
    case ir::Kind::kWchar:
      return std::nullopt;
    default:
      if (ir::is_signed(machine)) return TextForm{NativeId::kI64ToString, ir::Scalar::kI64};
      return TextForm{NativeId::kU64ToString, ir::Scalar::kU64};
  }
}

std::optional<TextForm> value_form(ir::Kind kind, ir::Scalar machine) {
  switch (kind) {
    case ir::Kind::kBool:
      return TextForm{NativeId::kStringToBool, ir::Scalar::kBool};
    case ir::Kind::kReal:
    case ir::Kind::kLreal:
      return TextForm{NativeId::kStringToF64, ir::Scalar::kF64};
    case ir::Kind::kTime:
    case ir::Kind::kLtime:
      return TextForm{NativeId::kStringToTime, ir::Scalar::kI64};
    default:
      if (kind > ir::Kind::kLreal) return std::nullopt;
      if (ir::is_signed(machine)) return TextForm{NativeId::kStringToI64, ir::Scalar::kI64};
      return TextForm{NativeId::kStringToU64, ir::Scalar::kU64};
  }
}

}  // namespace

// A WSTRING as STRING; strings as they are.
ir::Place Body::narrow_string(ir::Place source, bool is_wide) {
  if (!is_wide) return source;
  ir::Place out = temporary_place(sema_.program.types.string(types()[source.type].capacity));
  native(NativeId::kWstringToString, {string_value(out), string_value(source)});
  return out;
}

ir::Place Body::to_string(const Expr& call, const Conversion& conversion, ir::TypeId type) {
  ExprId argument = tree_.args[call.args.first].value;
  const Note& note = sema_.infer(argument);
  bool to_wide = conversion.to == ir::Kind::kWstring;
  ir::Place text;
  if (is_string(types(), note.type)) {
    text = place(argument);
    if (wide(text.type) == to_wide) return text;
    if (!to_wide) return narrow_string(text, true);
  } else {
    ir::TypeId from = !conversion.any_source && ir::is_elementary(conversion.from)
                          ? elementary(conversion.from)
                          : without_range(types(), note.type);
    ir::ValueId source = value(argument, from);
    auto form = text_form(types().root_kind(from), scalar(from));
    text = temporary_place(sema_.program.types.string(kNumberText));
    if (!form) {
      sema_.error(DiagnosticCode::kNotSupported, call.span,
                  "conversion of `" + sema_.type_text(from) + "` to a string");
      return text;
    }
    source = machine_convert(source, scalar(from), form->machine);
    native(form->native, {string_value(text), source});
    if (!to_wide) return text;
  }
  ir::Place out = temporary_place(type);
  native(NativeId::kStringToWstring, {string_value(out), string_value(text)});
  return out;
}

ir::ValueId Body::from_string(ExprId source, ir::TypeId to, base::SourceSpan span) {
  ir::Place text = place(source);
  text = narrow_string(text, wide(text.type));
  auto form = value_form(types().root_kind(to), scalar(to));
  if (!form) {
    sema_.error(DiagnosticCode::kNotSupported, span,
                "conversion of a string to `" + sema_.type_text(to) + "`");
    return zero(to);
  }
  ir::ValueId result = native(form->native, {string_value(text)});
  return machine_convert(result, form->machine, scalar(to));
}

// Result and arguments are typed by the row in natives.def.
ir::ValueId Body::native(stdlib::NativeId id, std::vector<ir::ValueId> operands) {
  uint32_t number = static_cast<uint32_t>(id);
  char result = stdlib::native_row(number).result;
  if (result == 'v') {
    build_.call_native(number, std::move(operands));
    return {};
  }
  return build_.call_native(number, stdlib::native_scalar(result), std::move(operands));
}

}  // namespace frontend
