#include "vm/native/x64/emitter.h"

namespace vm::native::x64 {
namespace {

bool asks_bits(Cond cond) { return cond == Cond::kNoBit || cond == Cond::kAnyBit; }
constexpr int8_t kArguments[] = {3, 2, 1, 5};  // rsi, rdx, rcx, r8
constexpr uint32_t kLostAtCalls = 0xff;        // all but r15

bool fits32(uint64_t bits, uint8_t width) {
  if (width < 8) return true;
  const auto v = static_cast<int64_t>(bits);
  return v >= INT32_MIN && v <= INT32_MAX;
}

}  // namespace

bool has_and_not() {
#if defined(__x86_64__)
  static const bool kHas = __builtin_cpu_supports("bmi") != 0;
  return kHas;
#else
  return false;
#endif
}

Demands X64Target::demands(const Function& f, const Node& node) const {
  Demands d;
  if (node.folded != 0xff) d.shares = 0x0f;  // the address is read after the first operand
  switch (node.op) {
    case Op::kDivS:
    case Op::kDivU:
    case Op::kModS:
    case Op::kModU:
      d.in[0] = 0;
      d.result = node.op == Op::kDivS || node.op == Op::kDivU ? 0 : 2;
      d.clobbers = 1u << 0 | 1u << 2;
      break;
    case Op::kMulHighS:
    case Op::kMulHighU:
      d.in[0] = 0;
      d.result = 2;
      d.clobbers = 1u << 0 | 1u << 2;
      break;
    case Op::kShl:
    case Op::kShr:
    case Op::kSar:
    case Op::kRol:
    case Op::kRor:
      if (!f.values[node.in[1]].constant) {
        d.in[1] = 1;
        d.shares = 1;
      }
      break;
    case Op::kCall:
      d.clobbers_all = true;
      if (node.in[0] != kNone) d.in[0] = 0;
      if (node.in[1] != kNone) d.in[1] = 2;
      if (node.in[2] != kNone) d.in[2] = 4;
      break;
    case Op::kNative:
      for (uint32_t i = 0; i < 4; ++i) {
        if (node.in[i] != kNone) d.in[i] = kArguments[i];
      }
      d.result = 0;
      d.clobbers = kLostAtCalls;
      d.clobbers_floats = ~0u;
      break;
    case Op::kResolve:
    case Op::kMoveHandle:
    case Op::kReach:
      d.shares = 0;  // what it is computed of is asked for again
      break;
    case Op::kHelper:
      d.clobbers_all = true;
      break;
    default:
      break;
  }
  return d;
}

bool X64Target::takes_constant(const Function& f, const Node& node, uint32_t operand) const {
  const Value& value = f.values[node.in[operand]];
  switch (node.op) {
    case Op::kNative:
      return true;
    case Op::kStore:
      return operand == 0;
    case Op::kMoveHandle:
    case Op::kAdd:
    case Op::kSub:
    case Op::kMul:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kCompare:
    case Op::kExitIf:
      return operand == 1 && !value.floating && fits32(value.bits, node.width);
    case Op::kSelectCmp:
      return operand == 3 && fits32(value.bits, node.from);
    case Op::kShl:
    case Op::kShr:
    case Op::kSar:
    case Op::kRol:
    case Op::kRor:
    case Op::kAndNot:
    case Op::kOrNot:
      return operand == 1;
    default:
      return false;
  }
}

bool X64Target::takes_memory(const Function&, const Node& node, uint32_t operand) const {
  const bool and_not = node.op == Op::kAndNot || node.op == Op::kOrNot;
  return static_cast<int>(operand) == (and_not ? 1 : folds(node));
}

int X64Target::folds(const Node& node) const {
  switch (node.op) {
    case Op::kAdd:
    case Op::kSub:
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
    case Op::kFAdd:
    case Op::kFSub:
    case Op::kFMul:
    case Op::kFDiv:
      return 1;
    case Op::kMul:
      return node.width >= 4 ? 1 : -1;
    case Op::kCompare:
    case Op::kExitIf:
      return asks_bits(node.cond) ? -1 : 1;
    case Op::kSext:
    case Op::kZext:
      return 0;
    default:
      return -1;
  }
}

// Compared with a constant; a BOOL with zero only.
bool X64Target::end_takes_memory(const Function& f, const End& end) const {
  if (end.compare != Op::kCompare || !f.values[end.in[1]].constant) return false;
  if (!end_takes_constant(f, end, 1) || asks_bits(end.cond)) return false;
  const bool equality = end.cond == Cond::kEq || end.cond == Cond::kNe;
  return end.width != 1 || (equality && f.values[end.in[1]].bits == 0);
}

bool X64Target::end_takes_constant(const Function& f, const End& end, uint32_t operand) const {
  const Value& value = f.values[end.in[operand]];
  return operand == 1 && end.compare == Op::kCompare && fits32(value.bits, end.width);
}

}  // namespace vm::native::x64
