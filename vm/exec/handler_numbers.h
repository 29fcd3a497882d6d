// Numbers of handlers: opcodes in table order, and for each the allowed operand bases
// of a, b and c, as the columns of opcodes.def say.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ir/bytecode/code.h"

namespace vm {

struct BaseCounts {
  uint32_t a = 1;
  uint32_t b = 1;
  uint32_t c = 1;
  constexpr uint32_t product() const { return a * b * c; }
};

// How many bases a column allows, from kFrame on (Field::allows).
constexpr uint32_t bases_of_column(std::string_view column) {
  if (column == "BASE" || column == "BC32") return 4;
  if (column.size() < 2 || column[1] != '_') return 1;
  if (column[0] == 'S') return 4;
  return column[0] == 'D' || column[0] == 'R' ? 3 : 1;
}

inline constexpr std::array<BaseCounts, ir::kOpcodeCount> kBaseCounts = {{
#define OP(name, a, b, c, x, y, flags, meaning) \
  {bases_of_column(#a), bases_of_column(#b), bases_of_column(#c)},
#include "ir/bytecode/opcodes.def"
#undef OP
}};

inline constexpr std::array<uint32_t, ir::kOpcodeCount + 1> kFirstHandler = [] {
  std::array<uint32_t, ir::kOpcodeCount + 1> first{};
  for (uint32_t i = 0; i < ir::kOpcodeCount; ++i)
    first[i + 1] = first[i] + kBaseCounts[i].product();
  return first;
}();
inline constexpr uint32_t kHandlerCount = kFirstHandler[ir::kOpcodeCount];
// Side units of native code: its bits 16 to 63 are the address of machine code to go on at, and the
// end of what a helper does.
inline constexpr uint32_t kResumeHandler = kHandlerCount;
inline constexpr uint32_t kStopHandler = kHandlerCount + 1;
// The handler of versions of POUs while variables are forced (store_aside.h).
inline constexpr uint32_t kAsideHandler = kHandlerCount + 2;
inline constexpr uint32_t kRestoreHandler = kHandlerCount + 3;
// The handler of boolean logic (truth_tables.h).
inline constexpr uint32_t kTruthTables = kHandlerCount + 4;
// Fused handlers (fusion.h) come after these.
inline constexpr uint32_t kFirstFused = kHandlerCount + 5;
inline constexpr uint32_t kHandlerLimit = kFirstFused + 2048;
static_assert(kHandlerLimit <= 65536, "a handler number fits the op field");

constexpr uint32_t handler_number(ir::Opcode op, ir::Base a, ir::Base b, ir::Base c) {
  const auto i = static_cast<uint32_t>(op);
  const BaseCounts& counts = kBaseCounts[i];
  return kFirstHandler[i] +
         (static_cast<uint32_t>(a) * counts.b + static_cast<uint32_t>(b)) * counts.c +
         static_cast<uint32_t>(c);
}

// The bases of combination `i` of an opcode.
constexpr ir::Base base_of_a(ir::Opcode op, uint32_t i) {
  const BaseCounts& counts = kBaseCounts[static_cast<uint32_t>(op)];
  return static_cast<ir::Base>(i / counts.c / counts.b);
}
constexpr ir::Base base_of_b(ir::Opcode op, uint32_t i) {
  const BaseCounts& counts = kBaseCounts[static_cast<uint32_t>(op)];
  return static_cast<ir::Base>(i / counts.c % counts.b);
}
constexpr ir::Base base_of_c(ir::Opcode op, uint32_t i) {
  return static_cast<ir::Base>(i % kBaseCounts[static_cast<uint32_t>(op)].c);
}

}  // namespace vm
