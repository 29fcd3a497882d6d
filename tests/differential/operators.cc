// Operators by type. The left operand is never constant where the compiler would compute the
// result and refuse overflow.
#include "tests/differential/builder.h"

namespace differential {
namespace {

constexpr const char* kCompare[] = {"=", "<>", "<", "<=", ">", ">="};
constexpr const char* kLogic[] = {"AND", "OR", "XOR", "AND", "OR", "&"};

std::string infix(const char* op) { return std::string("(@0 ") + op + " @1)"; }

}  // namespace

Expr Builder::bool_operation(int depth) {
  TypeRef type = elementary(ir::Kind::kBool);
  switch (below(10)) {
    case 8:
      if (!bits_.empty()) return use(bits_[below(count(bits_))], depth);
      return read(type);
    case 9:
      if (std::optional<Expr> test = pointer_test(depth)) return std::move(*test);
      return read(type);
    case 0:
      return node(type, infix(one_in(2) ? (iec_ ? "AND" : "AND_THEN") : iec_ ? "OR" : "OR_ELSE"),
                  {expression(type, depth - 1), expression(type, depth - 1)});
    case 1:
    case 2:
      return node(type, infix(kLogic[below(6)]),
                  {expression(type, depth - 1), expression(type, depth - 1)});
    case 3:
      return node(type, "(NOT @0)", {expression(type, depth - 1)});
    case 4: {
      TypeRef word =
          elementary(static_cast<ir::Kind>(static_cast<uint32_t>(ir::Kind::kByte) + below(4)));
      std::optional<Expr> from = variable(word);
      uint32_t bits = 8u << (word - elementary(ir::Kind::kByte));
      if (!from) return read(type);
      return node(type, std::string(one_in(2) ? "@0." : "@0.%X") + std::to_string(below(bits)),
                  {std::move(*from)});
    }
    default: {
      TypeRef compared = any_scalar();
      Expr left = one_in(2) ? read(compared) : expression(compared, depth - 1);
      return node(type, infix(kCompare[below(6)]),
                  {std::move(left), expression(compared, depth - 1)});
    }
  }
}

Expr Builder::division(TypeRef type, int depth) {
  std::string op = infix(one_in(2) && is_integer(type) ? "MOD" : "/");
  if (trap_in(40)) return node(type, op, {read(type), read(type)});
  if (one_in(3)) {
    // One is added to something that is not negative.
    return node(type, op, {read(type), small_integer(type, 1, 100, depth - 1)});
  }
  return node(type, op, {read(type), constant_text(type, std::to_string(1 + below(99)))});
}

// A type that converts to this one by itself.
std::optional<TypeRef> Builder::narrower(TypeRef type) {
  static constexpr std::pair<ir::Kind, ir::Kind> kSteps[] = {
      {ir::Kind::kInt, ir::Kind::kSint},   {ir::Kind::kDint, ir::Kind::kInt},
      {ir::Kind::kLint, ir::Kind::kDint},  {ir::Kind::kUint, ir::Kind::kUsint},
      {ir::Kind::kUdint, ir::Kind::kUint}, {ir::Kind::kUlint, ir::Kind::kUdint},
      {ir::Kind::kDint, ir::Kind::kUint},  {ir::Kind::kInt, ir::Kind::kUsint},
      {ir::Kind::kLreal, ir::Kind::kReal}, {ir::Kind::kReal, ir::Kind::kInt},
      {ir::Kind::kLreal, ir::Kind::kDint}, {ir::Kind::kWord, ir::Kind::kByte},
      {ir::Kind::kDword, ir::Kind::kWord}, {ir::Kind::kLword, ir::Kind::kDword},
      {ir::Kind::kLtime, ir::Kind::kTime}, {ir::Kind::kLdt, ir::Kind::kDt},
      {ir::Kind::kLtod, ir::Kind::kTod},   {ir::Kind::kLdate, ir::Kind::kDate},
  };
  for (int tries = 0; tries < 6; ++tries) {
    const auto& [to, from] = kSteps[below(std::size(kSteps))];
    if (elementary(to) == type) return elementary(from);
  }
  return std::nullopt;
}

Expr Builder::integer_operation(TypeRef type, int depth) {
  static constexpr const char* kArithmetic[] = {"+", "-", "*"};
  switch (below(6)) {
    case 0:
    case 1: {
      std::optional<TypeRef> second = narrower(type);
      Expr right = second && one_in(3) ? read(*second) : expression(type, depth - 1);
      return node(type, infix(kArithmetic[below(3)]), {read(type), std::move(right)});
    }
    case 2:
      return division(type, depth);
    case 3:
      if (group(type) == ir::Group::kSigned) return node(type, "(-@0)", {read(type)});
      if (iec_) return conversion(type, depth);
      return node(type, infix(kLogic[below(3)]), {read(type), expression(type, depth - 1)});
    default:
      return conversion(type, depth);
  }
}

Expr Builder::bits_operation(TypeRef type, int depth) {
  switch (below(5)) {
    case 0:
    case 1:
      return node(type, infix(kLogic[below(6)]),
                  {expression(type, depth - 1), expression(type, depth - 1)});
    case 2:
      return node(type, "(NOT @0)", {expression(type, depth - 1)});
    case 3: {
      static constexpr const char* kParts[] = {".%B", ".%W", ".%D"};
      TypeRef wide = elementary(ir::Kind::kLword);
      bool is_character =
          type == elementary(ir::Kind::kByte) || type == elementary(ir::Kind::kWord);
      if (is_character && !iec_ && one_in(2)) {
        if (std::optional<Expr> found = character(type, false, depth)) return std::move(*found);
      }
      if (type == wide) return conversion(type, depth);
      uint32_t part = type - elementary(ir::Kind::kByte);
      std::optional<Expr> from = variable(wide);
      if (!from) return read(type);
      return node(type, std::string("@0") + kParts[part] + std::to_string(below(8u >> part)),
                  {std::move(*from)});
    }
    default:
      return conversion(type, depth);
  }
}

Expr Builder::real_operation(TypeRef type, int depth) {
  static constexpr const char* kArithmetic[] = {"+", "-", "*", "/"};
  switch (below(5)) {
    case 0:
    case 1: {
      std::optional<TypeRef> second = narrower(type);
      Expr right = second && one_in(3) ? read(*second) : expression(type, depth - 1);
      const char* op = kArithmetic[below(4)];
      // A constant zero as divisor is refused.
      if (*op == '/') right = read(type);
      return node(type, infix(op), {read(type), std::move(right)});
    }
    case 2:
      return node(type, "(-@0)", {read(type)});
    case 3:
      return node(type, "(@0 ** @1)", {small_real(type, depth - 1), small_real(type, depth - 1)});
    default:
      return conversion(type, depth);
  }
}

Expr Builder::duration_operation(TypeRef type, int depth) {
  bool is_long = type == elementary(ir::Kind::kLtime);
  static constexpr ir::Kind kNumbers[] = {ir::Kind::kInt, ir::Kind::kUdint, ir::Kind::kSint};
  TypeRef number = elementary(kNumbers[below(3)]);
  TypeRef point = elementary(is_long ? (one_in(2) ? ir::Kind::kLtod : ir::Kind::kLdt)
                                     : (one_in(2) ? ir::Kind::kTod : ir::Kind::kDt));
  switch (below(7)) {
    case 0:
    case 1:
      return node(type, infix(one_in(2) ? "+" : "-"), {read(type), expression(type, depth - 1)});
    case 2:
      return node(type, "(@0 * @1)", {read(type), expression(number, depth - 1)});
    case 3:
      return node(type, "(@0 / @1)", {read(type), small_integer(number, 1, 9, depth - 1)});
    case 4:
      return node(type, "(@0 - @1)", {read(point), expression(point, depth - 1)});
    case 5:
      return node(type, "(-@0)", {read(type)});
    default:
      return conversion(type, depth);
  }
}

Expr Builder::date_operation(TypeRef type, int depth) {
  bool day = type == elementary(ir::Kind::kDate) || type == elementary(ir::Kind::kLdate);
  bool is_long = type == elementary(ir::Kind::kLdt) || type == elementary(ir::Kind::kLtod);
  if (day || one_in(2)) return conversion(type, depth);
  TypeRef duration = elementary(is_long ? ir::Kind::kLtime : ir::Kind::kTime);
  return node(type, infix(one_in(2) ? "+" : "-"), {read(type), expression(duration, depth - 1)});
}

Expr Builder::text_operation(TypeRef type, int depth) {
  if (one_in(3)) return conversion(type, depth);
  std::optional<Expr> call = standard(type, depth);
  return call ? std::move(*call) : read(type);
}

}  // namespace differential
