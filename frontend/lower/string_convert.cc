// Conversions between strings and everything else: native functions do the work. Texts are written
// as STRING; a WSTRING is made of it, or narrowed before it is read.
#include <limits>

#include "frontend/lower/conversions.h"
#include "frontend/lower/value_code.h"
#include "frontend/sema/calls/calls.h"
#include "frontend/sema/calls/standard_calls.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {
namespace {

using stdlib::NativeId;

constexpr uint32_t kNumberText = 80;  // longer than any number, time or date

struct TextForm {
  NativeId native;
  ir::Scalar machine;
  bool has_long_form = false;  // a third argument says which one
};

TextForm text_form(ir::Kind kind, ir::Scalar machine) {
  switch (kind) {
    case ir::Kind::kBool:
      return {NativeId::kBoolToString, ir::Scalar::kBool};
    case ir::Kind::kReal:
      return {NativeId::kF32ToString, ir::Scalar::kF32};
    case ir::Kind::kLreal:
      return {NativeId::kF64ToString, ir::Scalar::kF64};
    case ir::Kind::kTime:
    case ir::Kind::kLtime:
      return {NativeId::kTimeToString, ir::Scalar::kI64, true};
    case ir::Kind::kDate:
    case ir::Kind::kLdate:
      return {NativeId::kDateToString, ir::Scalar::kI64, true};
    case ir::Kind::kTod:
    case ir::Kind::kLtod:
      return {NativeId::kTodToString, ir::Scalar::kI64, true};
    case ir::Kind::kDt:
    case ir::Kind::kLdt:
      return {NativeId::kDtToString, ir::Scalar::kI64, true};
    case ir::Kind::kChar:
    case ir::Kind::kWchar:
      return {NativeId::kCharToString, ir::Scalar::kU64};
    default:
      if (ir::is_signed(machine)) return {NativeId::kI64ToString, ir::Scalar::kI64};
      return {NativeId::kU64ToString, ir::Scalar::kU64};
  }
}

TextForm value_form(ir::Kind kind, ir::Scalar machine) {
  switch (ir::elementary_group(kind)) {
    case ir::Group::kReal:
      return {NativeId::kStringToF64, ir::Scalar::kF64};
    case ir::Group::kDuration:
      return {NativeId::kStringToTime, ir::Scalar::kI64};
    case ir::Group::kDate:
      return {NativeId::kStringToDate, ir::Scalar::kI64};
    default:
      if (kind == ir::Kind::kBool) return {NativeId::kStringToBool, ir::Scalar::kBool};
      if (ir::is_signed(machine)) return {NativeId::kStringToI64, ir::Scalar::kI64};
      return {NativeId::kStringToU64, ir::Scalar::kU64};
  }
}

bool is_character_kind(ir::Kind kind) { return ir::elementary_group(kind) == ir::Group::kChar; }

}  // namespace

// A WSTRING as STRING; strings as they are.
ir::Place Conversions::narrow_string(ir::Place source, bool is_wide) {
  if (!is_wide) return source;
  ir::Place out = temporary_place(sema_.program.types.string(types()[source.type].capacity));
  code_.native(NativeId::kWstringToString, {code_.string_value(out), code_.string_value(source)});
  return out;
}

ir::Place Conversions::to_string(const Expr& call, const Conversion& conversion, ir::TypeId type) {
  ExprId argument = ask<Calls>().conversion_argument(call);
  const Note& note = infer(argument);
  bool named = !conversion.any_source && ir::is_elementary(conversion.from);
  if (is_string(types(), note.type) && !named) return string_to_string(argument, type);
  ir::TypeId from =
      without_range(types(), named ? elementary(conversion.from) : computed_type(sema_, note));
  Typed source{value(argument, from), from};
  ir::Place out = temporary_place(type);
  if (wide(type) && is_character_kind(types().root_kind(from))) {
    ir::ValueId code = code_.machine_convert(source.value, scalar(from), ir::Scalar::kU64);
    code_.native(NativeId::kCharToWstring, {code_.string_value(out), code});
    return out;
  }
  ir::Place text = wide(type) ? temporary_place(sema_.program.types.string(kNumberText)) : out;
  write_text(text, source);
  if (wide(type))
    code_.native(NativeId::kStringToWstring, {code_.string_value(out), code_.string_value(text)});
  return out;
}

ir::Place Conversions::string_to_string(ExprId source, ir::TypeId type) {
  ir::Place text = place(source);
  if (wide(text.type) == wide(type)) return text;
  if (!wide(type)) return narrow_string(text, true);
  ir::Place out = temporary_place(type);
  code_.native(NativeId::kStringToWstring, {code_.string_value(out), code_.string_value(text)});
  return out;
}

void Conversions::write_text(const ir::Place& text, Typed source) {
  if (is_enum(types(), source.type) && ask<StandardCalls>().prints_names(source.type)) {
    return write_enumerator_name(text, source);
  }
  ir::Kind kind = types().root_kind(source.type);
  TextForm form = text_form(kind, scalar(source.type));
  ir::ValueId number = code_.machine_convert(source.value, scalar(source.type), form.machine);
  if (!form.has_long_form) {
    code_.native(form.native, {code_.string_value(text), number});
    return;
  }
  ir::ValueId is_long = build_.constant(ir::Scalar::kBool, is_long_time(kind) ? 1 : 0);
  code_.native(form.native, {code_.string_value(text), number, is_long});
}

// The number first; a literal of that value replaces it.
void Conversions::write_enumerator_name(const ir::Place& text, Typed source) {
  ir::Scalar machine = scalar(source.type);
  ir::TypeId type = without_range(types(), source.type);
  ir::ValueId number = code_.machine_convert(source.value, machine, ir::Scalar::kI64);
  code_.native(NativeId::kI64ToString, {code_.string_value(text), number});
  const std::vector<ir::EnumLiteral> literals = types()[type].literals;
  for (const ir::EnumLiteral& literal : literals) {
    ir::BlockId take = build_.new_block();
    ir::BlockId next = build_.new_block();
    ir::ValueId code = build_.constant(machine, static_cast<uint64_t>(literal.value));
    build_.branch(build_.compare(ir::Op::kEq, machine, source.value, code), take, next);
    build_.start(take);
    ir::Place name;
    name.base = ir::PlaceBase::kConst;
    name.base_type = name.type =
        sema_.program.types.string(static_cast<uint32_t>(literal.name.size()));
    name.constant = sema_.program.constants.add({0, literal.name, {}});
    build_.copy(text, name);
    build_.jump(next);
    build_.start(next);
  }
}

// What is too large for the target becomes its nearest value.
ir::ValueId Conversions::from_string(ExprId source, ir::TypeId to) {
  ir::Place text = place(source);
  ir::Kind kind = types().root_kind(to);
  if (is_character_kind(kind)) return character_of(text, to);
  text = narrow_string(text, wide(text.type));
  TextForm form = value_form(kind, scalar(to));
  ir::ValueList operands{code_.string_value(text)};
  if (form.native == NativeId::kStringToDate) {
    operands.push_back(build_.constant(ir::Scalar::kI32, static_cast<uint64_t>(kind)));
  }
  ir::ValueId result = code_.native(form.native, operands);
  return code_.clamp(result, form.machine, scalar(to));
}

ir::ValueId Conversions::character_of(const ir::Place& text, ir::TypeId to) {
  if (!wide(text.type) || types().root_kind(to) == ir::Kind::kChar) {
    ir::Place narrow = narrow_string(text, wide(text.type));
    ir::ValueId code = code_.native(NativeId::kStringToChar, {code_.string_value(narrow)});
    return code_.machine_convert(code, ir::Scalar::kI32, scalar(to));
  }
  ir::ValueId code = code_.native(NativeId::kWstringToChar, {code_.string_value(text)});
  return code_.machine_convert(code, ir::Scalar::kI32, scalar(to));
}

ir::ValueId ValueCode::clamp(ir::ValueId number, ir::Scalar wide, ir::Scalar narrow) {
  if (ir::is_integer(wide) && ir::scalar_size(narrow) < ir::scalar_size(wide)) {
    Limits limits = limits_of(narrow);
    ir::ValueId most = build_.constant(wide, static_cast<uint64_t>(limits.high));
    number = build_.binary(ir::Op::kMin, wide, number, most);
    ir::ValueId least = build_.constant(wide, static_cast<uint64_t>(limits.low));
    number = build_.binary(ir::Op::kMax, wide, number, least);
  }
  return machine_convert(number, wide, narrow);
}

// Result and arguments are typed by the row in natives.def.
ir::ValueId ValueCode::native(stdlib::NativeId id, ir::ValueList operands) {
  uint32_t number = static_cast<uint32_t>(id);
  char result = stdlib::native_row(number).result;
  if (result == 'v') {
    build_.call_native(number, std::move(operands));
    return {};
  }
  return build_.call_native(number, stdlib::native_scalar(result), std::move(operands));
}

}  // namespace frontend
