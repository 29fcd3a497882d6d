#include <bit>

#include "vm/native/arm64/emitter.h"
#include "vm/native/arm64/immediates.h"

namespace vm::native::arm64 {
namespace {

bool can_compare(const Value& value, uint8_t width, Cond cond) {
  if (cond == Cond::kNoBit || cond == Cond::kAnyBit) {
    const uint64_t mask = width == 8 ? value.bits : value.bits & ((uint64_t{1} << (8 * width)) - 1);
    return logical_immediate(mask, width < 4 ? 4 : width).has_value();
  }
  return !value.floating && is_sum_immediate(compared_constant(value.bits, width, cond));
}

}  // namespace

int64_t compared_constant(uint64_t bits, uint8_t width, Cond cond) {
  if (width >= 4 || is_signed(cond)) return sign_extended(bits, width);
  return static_cast<int64_t>(bits & ((uint64_t{1} << (8 * width)) - 1));
}

Demands Arm64Target::demands(const Function&, const Node& node) const {
  Demands d;
  d.clobbers_all = node.op == Op::kHelper || node.op == Op::kCall;
  if (node.op == Op::kNative) {
    for (uint32_t i = 0; i < 4; ++i) {
      if (node.in[i] != kNone) d.in[i] = static_cast<int8_t>(i + 1);
    }
    d.result = 0;
    d.clobbers = 0xffff;           // all but x24 to x28
    d.clobbers_floats = ~0xff00u;  // of d8 to d15 what counts stays
  }
  if (node.op == Op::kCall) {
    if (node.in[0] != kNone) d.in[0] = 0;
    if (node.in[1] != kNone) d.in[1] = 1;
    if (node.in[2] != kNone) d.in[2] = 9;
  }
  return d;
}

bool Arm64Target::takes_constant(const Function& f, const Node& node, uint32_t operand) const {
  const Value& value = f.values[node.in[operand]];
  switch (node.op) {
    case Op::kNative:
      return true;
    case Op::kStore:
      return value.bits == 0;
    case Op::kAdd:
    case Op::kSub:
      return operand == 1 && is_sum_immediate(sign_extended(value.bits, node.width));
    case Op::kMul:
      return operand == 1 && std::has_single_bit(value.bits);
    case Op::kAnd:
    case Op::kOr:
    case Op::kXor:
      return operand == 1 && logical_immediate_of(value.bits, node.width).has_value();
    case Op::kCompare:
    case Op::kExitIf:
      return operand == 1 && can_compare(value, node.width, node.cond);
    case Op::kSelectCmp:
      return operand == 3 && can_compare(value, node.from, node.cond);
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

bool Arm64Target::takes_memory(const Function&, const Node&, uint32_t) const { return false; }

bool Arm64Target::end_takes_constant(const Function& f, const End& end, uint32_t operand) const {
  const Value& value = f.values[end.in[operand]];
  return operand == 1 && end.compare == Op::kCompare && can_compare(value, end.width, end.cond);
}

}  // namespace vm::native::arm64
