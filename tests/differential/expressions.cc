// Expressions: a literal, a variable, a call, a standard function, or an operator of the type.
#include "tests/differential/builder.h"

namespace differential {

// A scalar always; an aggregate when something of its type is in sight.
bool Builder::possible(TypeRef type) {
  if (is(type, Form::kOpenArray)) return find_open(type, false) != nullptr;
  return !is_aggregate(type) || find(type, false) != nullptr;
}

Expr Builder::node(TypeRef type, std::string pattern, std::vector<Expr> operands) {
  Expr expr;
  expr.type = type;
  expr.pattern = std::move(pattern);
  expr.operands = std::move(operands);
  return expr;
}

Expr Builder::expression(TypeRef type, int depth) {
  if (is(type, Form::kPointer)) return pointer_value(type, depth);
  if (is(type, Form::kOpenArray)) {
    Expr array = use(*find_open(type, false), 1);
    array.fixed = true;
    return array;
  }
  if (is_aggregate(type)) {
    if (depth > 0 && one_in(3)) {
      if (std::optional<Expr> call = function_call(type, depth)) return std::move(*call);
    }
    std::optional<Expr> found = variable(type);
    return found ? std::move(*found) : initial(type);
  }
  if (depth <= 0) {
    if (one_in(4)) return literal(type);
    std::optional<Expr> found = variable(type);
    return found ? std::move(*found) : literal(type);
  }
  switch (below(10)) {
    case 7:
      if (std::optional<Expr> call = generic_call(type, depth)) return std::move(*call);
      break;
    case 0:
      return literal(type);
    case 1:
    case 2:
      if (std::optional<Expr> found = variable(type)) return std::move(*found);
      break;
    case 3:
      if (std::optional<Expr> call = method_call(type, depth)) return std::move(*call);
      if (std::optional<Expr> call = function_call(type, depth)) return std::move(*call);
      break;
    case 4:
    case 5:
    case 6:
      if (std::optional<Expr> call = standard(type, depth)) return std::move(*call);
      break;
    default:
      break;
  }
  return operation(type, depth);
}

Expr Builder::operation(TypeRef type, int depth) {
  switch (program_[type].form) {
    case Form::kString:
    case Form::kWstring:
      return text_operation(type, depth);
    case Form::kEnum:
      return enum_operation(type, depth);
    case Form::kSubrange:
      return subrange_operation(type, depth);
    default:
      break;
  }
  switch (group(type)) {
    case ir::Group::kBit:
      return type == elementary(ir::Kind::kBool) ? bool_operation(depth)
                                                 : bits_operation(type, depth);
    case ir::Group::kSigned:
    case ir::Group::kUnsigned:
      return integer_operation(type, depth);
    case ir::Group::kReal:
      return real_operation(type, depth);
    case ir::Group::kDuration:
      return duration_operation(type, depth);
    case ir::Group::kDate:
      return date_operation(type, depth);
    default:
      return read(type);
  }
}

Expr Builder::enum_operation(TypeRef type, int depth) {
  TypeRef choice = elementary(ir::Kind::kBool);
  return node(type, "SEL(@0, @1, @2)",
              {expression(choice, depth - 1), expression(type, depth - 1), literal(type)});
}

// Mostly within the range; a trap otherwise.
Expr Builder::subrange_operation(TypeRef type, int depth) {
  const Type& row = program_[type];
  TypeRef base = row.base;
  int64_t low = row.low;
  int64_t high = row.high;
  if (trap_in(40)) return node(type, "@0", {read(base)});
  return node(type, "LIMIT(@0, @1, @2)",
              {constant_text(base, integer_text(base, low == INT64_MIN ? low + 1 : low, false)),
               expression(base, depth - 1), constant_text(base, integer_text(base, high, false))});
}

Expr Builder::small_integer(TypeRef type, int64_t low, int64_t high, int depth) {
  return node(type, "LIMIT(@0, @1, @2)",
              {constant_text(type, std::to_string(low)), expression(type, depth),
               constant_text(type, std::to_string(high))});
}

std::optional<Expr> Builder::function_call(TypeRef type, int depth) {
  for (int tries = 0; tries < 3 && !functions_.empty(); ++tries) {
    const Interface& callee = functions_[below(static_cast<uint32_t>(functions_.size()))];
    bool fits = callee.result == type || (is_text(type) && callee.result != kNoType &&
                                          program_[callee.result].form == program_[type].form);
    if (!fits || (callee.recursive && descending_)) continue;
    std::optional<std::vector<Expr>> args = arguments(callee, false, depth - 1);
    if (!args) continue;
    return node(type, callee.name + "(@*)", std::move(*args));
  }
  return std::nullopt;
}

// s[i]: a number that counts from 0, with `iec` a character from 1.
std::optional<Expr> Builder::character(TypeRef type, bool writable, int depth) {
  const bool wide = type == elementary(iec_ ? ir::Kind::kWchar : ir::Kind::kWord);
  const Place* text = find_text(wide, writable);
  if (text == nullptr || text->constant) return std::nullopt;
  Bounds all{iec_ ? 1 : 0, program_[text->type].capacity};
  Expr from = use(*text, 1);
  from.fixed = true;
  return node(type, "@0[@1]", {std::move(from), index(all, depth)});
}

// Without the length of a string.
std::string Builder::plain_name(TypeRef type) const {
  std::string name = name_of(type);
  return name.substr(0, name.find('['));
}

// The conversion functions between elementary types, strings included.
Expr Builder::conversion(TypeRef to, int depth) {
  std::string target = plain_name(to);
  if (is_integer(to) && one_in(8)) {
    // Decimal digits only: every hexadecimal digit of what ends in 16#77 is below 8.
    return node(
        to, (one_in(2) ? "BCD_TO_" : "WORD_BCD_TO_") + target + "(@0)",
        {node(elementary(ir::Kind::kWord), "(@0 AND 16#77)", {read(elementary(ir::Kind::kWord))})});
  }
  if (is_bits(to) && one_in(8)) {
    TypeRef source = elementary(ir::Kind::kUint);
    return node(to, (one_in(2) ? "TO_BCD_" : "UINT_TO_BCD_") + target + "(@0)",
                {small_integer(source, 0, trap_in(20) ? 100 : 99, depth - 1)});
  }
  for (int tries = 0; tries < 6; ++tries) {
    TypeRef from = one_in(8) ? string_type(one_in(3), 12) : below(ir::kElementaryCount);
    if (from == to || !convertible(from, to)) continue;
    if (is_text(from) && is_text(to) && is(from, program_[to].form)) continue;
    bool real = group(from) == ir::Group::kReal && group(to) != ir::Group::kReal && !is_text(to);
    Expr operand = real && !trap_in(30) ? small_real(from, depth - 1) : expression(from, depth - 1);
    bool integer = is_integer(to);
    std::string name = real && integer && one_in(3) ? "TRUNC_" + target
                       : one_in(4)                  ? "TO_" + target
                                                    : plain_name(from) + "_TO_" + target;
    return node(to, name + "(@0)", {std::move(operand)});
  }
  return read(to);
}

Expr Builder::small_real(TypeRef type, int depth) {
  return node(type, "LIMIT(@0, @1, @2)",
              {constant_text(type, "0.0"), expression(type, depth), constant_text(type, "100.0")});
}

}  // namespace differential
