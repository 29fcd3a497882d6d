#include "ir/bytecode/code.h"

#include "base/check.h"

namespace ir {
namespace {

struct ColumnName {
  std::string_view text;
  FieldKind kind;
};

constexpr ColumnName kColumnNames[] = {
    {"-", FieldKind::kNone},          {"BASE", FieldKind::kBase},
    {"OFF", FieldKind::kOffset16},    {"BC32", FieldKind::kBc32},
    {"FRAME", FieldKind::kFrameSize}, {"CODE", FieldKind::kCode},
    {"NATIVE", FieldKind::kNative},   {"RANGE", FieldKind::kRange},
    {"TRAP", FieldKind::kTrap},       {"REL32", FieldKind::kRel32},
    {"P32", FieldKind::kPlace32},     {"BOUNDS", FieldKind::kBounds},
    {"TYPE", FieldKind::kType},       {"SIZE", FieldKind::kSize},
    {"CAP", FieldKind::kCapacity},    {"OFF32", FieldKind::kOffset32},
    {"NUM", FieldKind::kNumber},
};

constexpr std::string_view kClassNames[kClassCount] = {"B",   "8",   "16", "32", "64",
                                                       "F32", "F64", "A",  "S",  "W"};

// A column of opcodes.def that is not in its vocabulary stops the build: the
// throw is not a constant expression.
constexpr FieldKind near_kind(char letter) {
  switch (letter) {
    case 'D':
      return FieldKind::kDst;
    case 'S':
      return FieldKind::kSrc;
    case 'R':
      return FieldKind::kRead;
    case 'T':
      return FieldKind::kTemp;
    case 'F':
      return FieldKind::kFrameRead;
    case 'U':
      return FieldKind::kUpdate;
    default:
      throw "opcodes.def: unknown column";
  }
}

constexpr Class near_class(std::string_view text) {
  for (uint32_t i = 0; i < kClassCount; ++i) {
    if (kClassNames[i] == text) return static_cast<Class>(i);
  }
  throw "opcodes.def: unknown class";
}

constexpr Field parse_field(std::string_view text) {
  for (const ColumnName& column : kColumnNames) {
    if (column.text == text) return {column.kind, Class::kB};
  }
  if (text.size() < 3 || text[1] != '_') throw "opcodes.def: unknown column";
  return {near_kind(text[0]), near_class(text.substr(2))};
}

constexpr bool has_flag(std::string_view flags, std::string_view wanted) {
  while (!flags.empty()) {
    const size_t bar = flags.find('|');
    if (flags.substr(0, bar) == wanted) return true;
    if (bar == std::string_view::npos) return false;
    flags.remove_prefix(bar + 1);
  }
  return false;
}

constexpr OpcodeRow kRows[kOpcodeCount] = {
#define OP(name, a, b, c, x, y, flags, meaning) \
  {#name,                                       \
   parse_field(#a),                             \
   parse_field(#b),                             \
   parse_field(#c),                             \
   parse_field(#x),                             \
   parse_field(#y),                             \
   has_flag(#flags, "EXT"),                     \
   has_flag(#flags, "TRAP"),                    \
   has_flag(#flags, "BACK"),                    \
   has_flag(#flags, "CALL"),                    \
   has_flag(#flags, "END"),                     \
   meaning},
#include "ir/bytecode/opcodes.def"
#undef OP
};

constexpr Class kScalarClasses[kScalarCount] = {
    Class::kB,                                         // bool
    Class::k8,   Class::k16,  Class::k32, Class::k64,  // i8..i64
    Class::k8,   Class::k16,  Class::k32, Class::k64,  // u8..u64
    Class::kF32, Class::kF64, Class::kA,  Class::kS,  Class::kW,
};

}  // namespace

Class class_of(Scalar scalar) { return kScalarClasses[static_cast<uint32_t>(scalar)]; }

std::string_view class_name(Class cls) { return kClassNames[static_cast<uint32_t>(cls)]; }

const OpcodeRow& opcode_row(Opcode op) {
  base::check(static_cast<uint32_t>(op) < kOpcodeCount, "opcode in range");
  return kRows[static_cast<uint32_t>(op)];
}

Opcode opcode_from_name(std::string_view name) {
  for (uint32_t i = 0; i < kOpcodeCount; ++i) {
    if (kRows[i].name == name) return static_cast<Opcode>(i);
  }
  return static_cast<Opcode>(kOpcodeCount);
}

}  // namespace ir
