// The standard functions as the registry has them: what each rule takes and gives. A new
// function of a known rule takes part by itself.
#include <algorithm>
#include <sstream>

#include "frontend/sema/types/conversion.h"
#include "tests/differential/builder.h"

namespace differential {

using stdlib::FunctionRow;
using stdlib::FunctionRule;

// Characters convert to and from integers, bit strings and texts; a date has no time of day.
bool Builder::convertible(TypeRef from, TypeRef to) const {
  auto is_character = [&](TypeRef type) { return group(type) == ir::Group::kChar; };
  auto is_day = [](TypeRef type) {
    return type == elementary(ir::Kind::kDate) || type == elementary(ir::Kind::kLdate);
  };
  auto is_clock = [](TypeRef type) {
    return type == elementary(ir::Kind::kTod) || type == elementary(ir::Kind::kLtod);
  };
  if (is_character(from) || is_character(to)) {
    TypeRef other = is_character(from) ? to : from;
    return is_character(other) || is_integer(other) || is_bits(other) || is_text(other);
  }
  return !(is_day(from) && is_clock(to)) && !(is_clock(from) && is_day(to));
}

// The elementary type of that name in a signature; kNoType for a generic one.
TypeRef Builder::named_type(std::string_view name) {
  std::optional<ir::Kind> kind = frontend::kind_of_name(name);
  return kind && ir::is_elementary(*kind) ? elementary(*kind) : kNoType;
}

bool Builder::gives(const FunctionRow& row, TypeRef type) const {
  bool boolean = type == elementary(ir::Kind::kBool);
  switch (row.rule) {
    case FunctionRule::kNumberSame:
      return is_number(type) || group(type) == ir::Group::kDuration;
    case FunctionRule::kReal:
      return group(type) == ir::Group::kReal;
    case FunctionRule::kTrunc:
      return type == elementary(ir::Kind::kDint);
    case FunctionRule::kArithmetic:
      if (row.name == "MOD") return is_integer(type);
      return row.name == "EXPT" ? group(type) == ir::Group::kReal : is_number(type);
    case FunctionRule::kShift:
      return is_bits(type) || (is_integer(type) && !iec_);
    case FunctionRule::kBitwise:
    case FunctionRule::kNot:
      return boolean || is_bits(type);
    case FunctionRule::kMove:
    case FunctionRule::kSelect:
    case FunctionRule::kMux:
      return true;
    case FunctionRule::kExtreme:
      return !is_aggregate(type) && !is(type, Form::kSubrange);
    case FunctionRule::kCompare:
      return boolean;
    case FunctionRule::kString:
      return is_text(type);
    case FunctionRule::kStringNumber:
    case FunctionRule::kWeekday:
      return type == elementary(ir::Kind::kInt);
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
    case FunctionRule::kMoment:
      return named_type(stdlib::result_type(row)) == type;
    case FunctionRule::kByteOrder:
      return is_elementary(type);
    case FunctionRule::kValid:
      return boolean;
    case FunctionRule::kClock:
      return row.name == "TIME" ? type == elementary(ir::Kind::kTime)
                                : type == elementary(ir::Kind::kLtime);
    case FunctionRule::kSplit:
      break;  // has no result
  }
  return false;
}

std::vector<Expr> Builder::standard_operands(const FunctionRow& row, TypeRef type, int depth) {
  uint32_t count = row.most != 0 || row.fewest == 0 ? row.fewest : row.fewest + below(3);
  TypeRef small = elementary(one_in(3) ? ir::Kind::kUsint : ir::Kind::kInt);
  std::vector<Expr> out;
  auto more = [&](TypeRef wanted) { out.push_back(expression(wanted, depth - 1)); };
  switch (row.rule) {
    case FunctionRule::kTrunc:
      out.push_back(
          small_real(elementary(one_in(2) ? ir::Kind::kReal : ir::Kind::kLreal), depth - 1));
      return out;
    case FunctionRule::kArithmetic:
      out.push_back(row.name == "EXPT" ? small_real(type, depth - 1) : read(type));
      while (out.size() < count) {
        if (row.name == "DIV" || row.name == "MOD") {
          out.push_back(group(type) == ir::Group::kReal ? read(type)
                                                        : small_integer(type, 1, 50, depth - 1));
        } else {
          out.push_back(row.name == "EXPT" ? small_real(type, depth - 1)
                                           : expression(type, depth - 1));
        }
      }
      return out;
    case FunctionRule::kShift:
      more(type);
      out.push_back(small_integer(small, 0, 70, depth - 1));
      return out;
    case FunctionRule::kSelect:
      more(elementary(ir::Kind::kBool));
      more(type);
      more(type);
      return out;
    case FunctionRule::kMux:
      more(small);
      while (out.size() < count + 1) more(type);
      return out;
    case FunctionRule::kCompare: {
      TypeRef compared = any_scalar();
      out.push_back(read(compared));
      while (out.size() < count) more(compared);
      return out;
    }
    case FunctionRule::kString:
    case FunctionRule::kStringNumber: {
      bool wide = is_text(type) ? is(type, Form::kWstring) : one_in(3);
      bool two = row.name == "INSERT" || row.name == "REPLACE" || row.name == "FIND";
      uint32_t texts = row.name == "CONCAT" ? count : two ? 2 : 1;
      TypeRef text = string_type(wide, 12);
      while (out.size() < texts) more(text);
      while (out.size() < count) out.push_back(small_integer(small, 0, 9, depth - 1));
      return out;
    }
    case FunctionRule::kTimeSum:
    case FunctionRule::kTimeDifference:
    case FunctionRule::kTimeProduct:
    case FunctionRule::kTimeQuotient:
      while (out.size() < count) {
        TypeRef named = named_type(stdlib::operand_type(row, static_cast<uint32_t>(out.size())));
        out.push_back(named == kNoType ? small_integer(small, 1, 9, depth - 1)
                                       : expression(named, depth - 1));
      }
      return out;
    case FunctionRule::kMoment:
      return moment_parts(row, depth);
    case FunctionRule::kWeekday:
      more(elementary(one_in(2) ? ir::Kind::kDate : ir::Kind::kLdt));
      return out;
    case FunctionRule::kValid:
      more(elementary(row.name == "IS_VALID" ? (one_in(2) ? ir::Kind::kReal : ir::Kind::kLreal)
                                             : (one_in(2) ? ir::Kind::kByte : ir::Kind::kDword)));
      return out;
    case FunctionRule::kNumberSame:
    case FunctionRule::kReal:
    case FunctionRule::kBitwise:
    case FunctionRule::kNot:
    case FunctionRule::kMove:
    case FunctionRule::kExtreme:
    case FunctionRule::kClock:
    case FunctionRule::kByteOrder:
    case FunctionRule::kSplit:
      break;
  }
  while (out.size() < count) more(type);
  return out;
}

// Parts that make a date nearly always.
std::vector<Expr> Builder::moment_parts(const FunctionRow& row, int depth) {
  static constexpr std::pair<std::string_view, Bounds> kParts[] = {
      {"YEAR", {1970, 2200}}, {"MONTH", {1, 12}},  {"DAY", {1, 28}},         {"HOUR", {0, 23}},
      {"MINUTE", {0, 59}},    {"SECOND", {0, 59}}, {"MILLISECOND", {0, 999}}};
  std::vector<Expr> out;
  for (uint32_t i = 0; i < row.fewest; ++i) {
    std::string name = parameter_name(row, i);
    for (const auto& [part, bounds] : kParts) {
      if (part == name) {
        Bounds wide{bounds.low, bounds.high + (trap_in(60) ? 1 : 0)};
        out.push_back(small_integer(elementary(ir::Kind::kInt), wide.low, wide.high, depth - 1));
      }
    }
  }
  return out;
}

// "IN1+" numbers its parameters on; '>' marks outputs.
std::string Builder::parameter_name(const FunctionRow& row, uint32_t number) {
  std::vector<std::string> names;
  std::istringstream stream{std::string(row.parameters)};
  for (std::string name; stream >> name;) names.push_back(name);
  if (names.empty()) return {};
  std::string& last = names.back();
  if (last.back() != '+' || number + 1 < names.size()) {
    std::string name = number < names.size() ? names[number] : std::string();
    if (!name.empty() && (name.back() == '>' || name.back() == '+')) name.pop_back();
    return name;
  }
  // From the number that stands in front of the `+` on.
  last.pop_back();
  size_t digits = last.find_last_not_of("0123456789") + 1;
  uint32_t first = static_cast<uint32_t>(std::stoul(last.substr(digits)));
  auto offset = number - static_cast<uint32_t>(names.size() - 1);
  return last.substr(0, digits) + std::to_string(first + offset);
}

// SPLIT_DATE(IN := x, YEAR => y): a statement.
std::optional<Stmt> Builder::split_call(int depth) {
  std::vector<const FunctionRow*> rows;
  for (const FunctionRow& row : stdlib::function_rows()) {
    if (row.rule == FunctionRule::kSplit) rows.push_back(&row);
  }
  if (rows.empty()) return std::nullopt;
  const FunctionRow& row = *rows[below(static_cast<uint32_t>(rows.size()))];
  TypeRef type = named_type(stdlib::operand_type(row, 0));
  if (type == kNoType) return std::nullopt;
  Expr args = node(kNoType, "@*", {});
  args.operands.push_back(node(kNoType, "IN := @0", {expression(type, depth)}));
  for (uint32_t i = 1; i < row.most; ++i) {
    std::optional<Expr> to = target(elementary(one_in(2) ? ir::Kind::kInt : ir::Kind::kUdint));
    if (to && one_in(2)) {
      args.operands.push_back(node(kNoType, parameter_name(row, i) + " => @0", {std::move(*to)}));
    }
  }
  return simple(std::string(row.name) + "(@0);", {std::move(args)});
}

std::optional<Expr> Builder::standard(TypeRef type, int depth) {
  std::span<const FunctionRow> rows = stdlib::function_rows();
  bool formal = one_in(6);
  for (int tries = 0; tries < 12; ++tries) {
    const FunctionRow& row = rows[below(static_cast<uint32_t>(rows.size()))];
    if (!gives(row, type)) continue;
    std::vector<Expr> operands = standard_operands(row, type, depth);
    // NOT is an operator wherever it stands.
    bool named = formal && row.rule != FunctionRule::kNot;
    for (uint32_t i = 0; named && i < operands.size(); ++i) {
      operands[i] = node(kNoType, parameter_name(row, i) + " := @0", {std::move(operands[i])});
    }
    if (named && !operands.empty() && one_in(6)) {
      Expr enable = expression(elementary(ir::Kind::kBool), 1);
      operands.insert(operands.begin(), node(kNoType, "EN := @0", {std::move(enable)}));
    }
    return node(type, std::string(row.name) + "(@*)", std::move(operands));
  }
  return std::nullopt;
}

}  // namespace differential
