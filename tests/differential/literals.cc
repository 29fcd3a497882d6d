// Literals of every type, at the edges of their range more often than chance would have it.
#include "ir/types/value_text.h"
#include "tests/differential/builder.h"

namespace differential {
namespace {

std::string two_digits(uint32_t value) {
  return {static_cast<char>('0' + value / 10), static_cast<char>('0' + value % 10)};
}

}  // namespace

Expr Builder::constant_text(TypeRef type, std::string text) {
  Expr expr;
  expr.type = type;
  expr.pattern = std::move(text);
  expr.constant = true;
  return expr;
}

std::string Builder::integer_text(TypeRef type, int64_t value, bool bare) {
  std::string text = std::to_string(value);
  return bare ? text : name_of(type) + "#" + text;
}

std::string Builder::random_integer(TypeRef type, bool bare) {
  Bounds all = range(type);
  std::string prefix = bare ? "" : name_of(type) + "#";
  switch (below(8)) {
    case 0:
      return prefix + std::to_string(all.high);
    case 1:
      // The magnitude of the lowest LINT alone does not fit.
      return prefix + std::to_string(all.low == INT64_MIN ? all.low + 1 : all.low);
    case 2: {
      auto span = static_cast<uint64_t>(all.high) - static_cast<uint64_t>(all.low);
      uint64_t step = span == ~uint64_t{0} ? random_.next() : random_.next() % (span + 1);
      auto value = static_cast<int64_t>(static_cast<uint64_t>(all.low) + step);
      return prefix + std::to_string(value == INT64_MIN ? 0 : value);
    }
    case 3:
      return all.high >= 255
                 ? prefix + "16#" + "0123456789ABCDEF"[below(16)] + "0123456789ABCDEF"[below(16)]
                 : prefix + "1";
    default: {
      int64_t value = static_cast<int64_t>(below(20)) - 5;
      return prefix + std::to_string(std::min(all.high, std::max(all.low, value)));
    }
  }
}

std::string Builder::random_real(TypeRef type, bool bare) {
  static constexpr const char* kSpecial[] = {"0.0", "1.0E-30", "3.0E30", "0.5", "1.5", "2.5"};
  std::string text = one_in(4) ? kSpecial[below(6)]
                               : std::to_string(below(1000)) + "." + std::to_string(below(100));
  if (one_in(4)) text = "-" + text;
  return bare ? text : name_of(type) + "#" + text;
}

std::string Builder::random_time(TypeRef type) {
  std::string date = std::to_string(1970 + below(100)) + "-" + two_digits(1 + below(12)) + "-" +
                     two_digits(1 + below(28));
  std::string time = two_digits(below(24)) + ":" + two_digits(below(60)) + ":" +
                     two_digits(below(60)) + (one_in(3) ? "." + std::to_string(below(1000)) : "");
  switch (static_cast<ir::Kind>(type)) {
    case ir::Kind::kTime:
      return std::string(one_in(5) ? "T#-" : "T#") + std::to_string(below(100000)) + "ms";
    case ir::Kind::kLtime:
      return "LT#" + std::to_string(below(1000)) + "s" + std::to_string(below(1000)) + "us" +
             std::to_string(below(1000)) + "ns";
    case ir::Kind::kDate:
      return "D#" + date;
    case ir::Kind::kLdate:
      return "LD#" + date;
    case ir::Kind::kTod:
      return "TOD#" + time;
    case ir::Kind::kLtod:
      return "LTOD#" + time;
    case ir::Kind::kDt:
      return "DT#" + date + "-" + time;
    default:
      return "LDT#" + date + "-" + time;
  }
}

// Without `@`, which marks holes.
std::string Builder::random_text(bool wide, uint32_t length) {
  static constexpr const char* kNarrow[] = {"a",  "b",  "Z",  "0",   "7", " ",
                                            "$$", "$'", "$N", "$FF", "-", "."};
  static constexpr const char* kWide[] = {"a",  "b",   "Z",  "0",     "7",     " ",
                                          "$$", "$\"", "$N", "$00C4", "$20AC", "."};
  std::string text = wide ? "\"" : "'";
  for (uint32_t n = below(length + 1); n > 0; --n) text += (wide ? kWide : kNarrow)[below(12)];
  return text + (wide ? "\"" : "'");
}

Expr Builder::literal(TypeRef type, bool bare) {
  const Type& row = program_[type];
  switch (row.form) {
    case Form::kString:
    case Form::kWstring:
      return constant_text(type,
                           random_text(row.form == Form::kWstring, std::min(8u, row.capacity)));
    case Form::kEnum:
      return constant_text(type,
                           (one_in(3) ? row.name + "#" : "") +
                               row.literals[below(static_cast<uint32_t>(row.literals.size()))]);
    case Form::kSubrange: {
      Bounds all{row.low, row.high};
      int64_t value = one_in(3) ? all.low : one_in(2) ? all.high : 5;
      value = std::min(all.high, std::max(all.low, value));
      if (value == INT64_MIN) value = 0;
      return constant_text(type, integer_text(row.base, value, bare));
    }
    case Form::kPointer:
      return constant_text(type, "NULL");
    default:
      break;
  }
  switch (group(type)) {
    case ir::Group::kBit:
      if (type == elementary(ir::Kind::kBool)) {
        return constant_text(type, one_in(2) ? "TRUE" : "FALSE");
      }
      return constant_text(type, random_integer(type, bare));
    case ir::Group::kSigned:
    case ir::Group::kUnsigned:
      return constant_text(type, random_integer(type, bare));
    case ir::Group::kReal:
      return constant_text(type, random_real(type, bare));
    case ir::Group::kChar:
      return constant_text(type, type == elementary(ir::Kind::kChar)
                                     ? std::string("CHAR#'") + "abXY09 "[below(7)] + "'"
                                     : std::string("WCHAR#\"") + "abXY09 "[below(7)] + "\"");
    default:
      return constant_text(type, random_time(type));
  }
}

// An initial value: of an aggregate, some of its elements or members.
Expr Builder::initial(TypeRef type) {
  const Type& row = program_[type];
  Expr expr;
  expr.type = type;
  if (row.form == Form::kArray) {
    expr.pattern = "[@*]";
    for (uint32_t n = 1 + below(2); n > 0; --n) expr.operands.push_back(initial(row.base));
    if (row.dims.size() == 1 && one_in(3)) expr.operands.back().pattern.insert(0, "1(").append(")");
    return expr;
  }
  if (!is_aggregate(type)) return literal(type, true);
  expr.pattern = "(@*)";
  std::vector<Variable> members = members_of(program_, type);
  if (row.form == Form::kUnion) members = {members[below(count(members))]};
  for (const Variable& member : members) {
    if (one_in(2) && !expr.operands.empty()) continue;
    Expr part;
    part.pattern = member.name + " := @0";
    part.operands.push_back(initial(member.type));
    expr.operands.push_back(std::move(part));
  }
  return expr;
}

}  // namespace differential
