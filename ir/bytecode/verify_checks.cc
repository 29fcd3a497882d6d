#include "ir/bytecode/verify_checks.h"

namespace ir::verification {
namespace {

OperandCheck operand_check(const Field& field) {
  if (!field.is_near()) return {};
  return {field.cls, field.reads(), field.writes()};
}

// `first`: a bit for each value of the three base fields in which this field's is 0; `step`: how
// far the value 1 of it is from there.
uint64_t allowed_bases(const Field& field, uint64_t first, uint32_t step) {
  uint64_t allowed = 0;
  for (uint32_t base = 0; base < 4; ++base) {
    if (field.allows(static_cast<Base>(base))) allowed |= first << base * step;
  }
  return allowed;
}

bool is_plain(const OpcodeRow& row) {
  const auto scalar = [](const Field& field) { return field.is_near() && field.cls < Class::kA; };
  const auto scalar_or_none = [&](const Field& field) {
    return field.kind == FieldKind::kNone || scalar(field);
  };
  return scalar(row.a) && scalar_or_none(row.b) && scalar_or_none(row.c) && !row.extended &&
         !row.calls && !row.ends && !row.backward;
}

OpcodeChecks checks_of(Opcode op) {
  const OpcodeRow& row = opcode_row(op);
  const auto mask = [](const Field& field) {
    const bool unused = field.kind == FieldKind::kNone || field.kind == FieldKind::kBase;
    return unused ? uint16_t{0xffff} : uint16_t{0};
  };
  const auto extension = [](const Field& field) {
    return field.kind == FieldKind::kNone ? 0xffffffffu : 0u;
  };
  const bool wide = row.b.kind == FieldKind::kBc32 || row.b.kind == FieldKind::kRel32;
  OpcodeChecks out;
  out.first = bits_of({0, mask(row.a), mask(row.b), wide ? uint16_t{0} : mask(row.c)});
  if (row.extended) out.second = bits_of(Unit::extension(extension(row.x), extension(row.y)));
  out.bases = allowed_bases(row.a, 0x1111'1111'1111'1111, 1) &
              allowed_bases(row.b, 0x000f'000f'000f'000f, 4) &
              allowed_bases(row.c, 0x0000'0000'0000'ffff, 16);
  out.a = operand_check(row.a);
  out.b = operand_check(row.b);
  out.c = operand_check(row.c);
  out.extended = row.extended;
  out.ends = row.ends;
  out.calls = row.calls || op == Opcode::NATIVE;
  out.plain = is_plain(row);
  return out;
}

}  // namespace

const std::array<OpcodeChecks, kOpcodeCount>& opcode_checks() {
  static const std::array<OpcodeChecks, kOpcodeCount> kRows = [] {
    std::array<OpcodeChecks, kOpcodeCount> rows;
    for (uint32_t i = 0; i < kOpcodeCount; ++i) rows[i] = checks_of(static_cast<Opcode>(i));
    return rows;
  }();
  return kRows;
}

}  // namespace ir::verification
