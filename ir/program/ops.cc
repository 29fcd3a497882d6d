#include "ir/program/ops.h"

#include <array>

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

const char* trap_name(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].name; }
const char* trap_title(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].title; }
const char* trap_help(TrapKind kind) { return kTraps[static_cast<size_t>(kind)].help; }

}  // namespace ir
