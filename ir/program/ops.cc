#include "ir/program/ops.h"

#include <array>

#include "ir/program/eval_scalar.h"

namespace ir {
namespace {

struct OpRow {
  std::string_view name;
  int operands;
  bool result;
};
constexpr auto kOps = std::to_array<OpRow>({
#define OP(id, text, operands, result) {text, operands, result},
#include "ir/program/ops.def"
#undef OP
});

struct TrapRow {
  const char* name;
  const char* title;
  const char* help;
};
constexpr auto kTraps = std::to_array<TrapRow>({
#define TRAP(id, text, title, help) {text, title, help},
#include "ir/program/traps.def"
#undef TRAP
});
static_assert(kTraps.size() == kTrapCount);

}  // namespace

std::string_view op_name(Op op) { return kOps[static_cast<size_t>(op)].name; }
int op_operand_count(Op op) { return kOps[static_cast<size_t>(op)].operands; }
bool op_has_result(Op op) { return kOps[static_cast<size_t>(op)].result; }
bool is_terminator(Op op) { return op >= Op::kJump; }

uint64_t target_count(const Inst& inst) {
  switch (inst.op) {
    case Op::kJump:
    case Op::kEndTry:
      return 1;
    case Op::kBranch:
    case Op::kTry:
      return 2;
    case Op::kSwitch:
      return static_cast<uint64_t>(inst.high) - static_cast<uint64_t>(inst.low) + 2;
    default:
      return 0;
  }
}

bool fits_switch(Scalar scalar, int64_t number) {
  const auto bits = static_cast<uint64_t>(number);
  return canonical(scalar, bits) == bits && canonical(Scalar::kI32, bits) == bits &&
         (number >= 0 || is_signed(scalar));
}

const Target& taken_target(const Inst& end, uint64_t bits) {
  if (end.op == Op::kBranch) return end.targets[bits != 0 ? 0 : 1];
  const auto low = static_cast<uint64_t>(end.low);
  const bool inside = bits - low <= static_cast<uint64_t>(end.high) - low;
  return end.targets[inside ? 1 + (bits - low) : 0];
}

const char* trap_name(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].name; }
const char* trap_title(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].title; }
const char* trap_help(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].help; }

}  // namespace ir
