#include "ir/program/text_names.h"

#include <algorithm>
#include <charconv>

#include "ir/program/ops.h"
#include "ir/types/value_text.h"
#include "stdlib/native/natives.h"

namespace ir {
namespace {

// The elementary type whose literals stand for a machine scalar.
TypeId literal_type(Scalar scalar) {
  constexpr std::array<Kind, 14> kKinds = {Kind::kBool,  Kind::kSint,  Kind::kInt,   Kind::kDint,
                                           Kind::kLint,  Kind::kUsint, Kind::kUint,  Kind::kUdint,
                                           Kind::kUlint, Kind::kReal,  Kind::kLreal, Kind::kUdint,
                                           Kind::kUlint, Kind::kUlint};
  return TypeId(static_cast<uint32_t>(kKinds[static_cast<size_t>(scalar)]));
}

bool is_decimal(char c) { return c >= '0' && c <= '9'; }

}  // namespace

bool shows_scalar(Op op) { return op_has_result(op) || op == Op::kStore || op == Op::kSwitch; }

Scalar result_scalar(const Inst& inst) {
  return inst.op >= Op::kEq && inst.op <= Op::kLe ? Scalar::kBool : inst.scalar;
}

bool is_word_byte(char c) {
  return is_decimal(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<uint8_t>(c) >= 0x80;
}

std::string name_text(std::string_view name) {
  const bool word =
      !name.empty() && !is_decimal(name[0]) && std::all_of(name.begin(), name.end(), is_word_byte);
  return word ? std::string(name) : string_text(name);
}

std::string native_text(uint32_t native) {
  if (native >= stdlib::native_count()) {
    return "#" + std::to_string(native);
  }
  const stdlib::NativeRow& row = stdlib::native_row(native);
  return std::string(row.name) + "/" + row.result + ":" + std::string(row.arguments);
}

std::string immediate_text(Scalar scalar, uint64_t bits) {
  const TypeTable types;
  const std::string text = scalar_text(types, literal_type(scalar), bits);
  uint64_t back = 0;
  if (parse_immediate(scalar, text, back) && back == bits) {
    return text;
  }
  char buffer[16];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, bits, 16);
  return "16#" + std::string(buffer, end.ptr);
}

bool parse_immediate(Scalar scalar, std::string_view text, uint64_t& bits) {
  if (text.starts_with("16#")) {
    const auto read = std::from_chars(text.data() + 3, text.data() + text.size(), bits, 16);
    return read.ec == std::errc() && read.ptr == text.data() + text.size();
  }
  const base::Result<uint64_t> parsed = parse_scalar(TypeTable(), literal_type(scalar), text);
  bits = parsed.ok() ? *parsed : 0;
  return parsed.ok();
}

}  // namespace ir
