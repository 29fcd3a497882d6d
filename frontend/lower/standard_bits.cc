// Standard functions that look at the bits of a value: order of bytes, validity.
#include <limits>

#include "frontend/lower/standard_code.h"

namespace frontend {
namespace {

using stdlib::FunctionId;
using stdlib::NativeId;

ir::Scalar bits_of_float(ir::Scalar machine) {
  if (machine == ir::Scalar::kF32) return ir::Scalar::kU32;
  return machine == ir::Scalar::kF64 ? ir::Scalar::kU64 : machine;
}

}  // namespace

// Values are little endian on every machine, so one direction of each pair is the value itself.
ir::ValueId StandardCode::byte_order(ExprId argument, const stdlib::FunctionRow& row,
                                     ir::TypeId own) {
  ir::ValueId in = value(argument, own);
  ir::Scalar machine = scalar(own);
  uint32_t bytes = ir::scalar_size(machine);
  bool swaps = row.id == FunctionId::kToBigEndian || row.id == FunctionId::kFromBigEndian;
  if (!swaps || bytes == 1) return in;
  ir::Scalar plain = bits_of_float(machine);
  if (plain != machine) in = build_.unary(ir::Op::kBits, plain, in);
  ir::ValueId bits = code_.machine_convert(in, plain, ir::Scalar::kU64);
  bits = code_.native(NativeId::kSwapBytes, {bits, build_.constant(ir::Scalar::kI32, bytes)});
  bits = code_.machine_convert(bits, ir::Scalar::kU64, plain);
  return plain != machine ? build_.unary(ir::Op::kBits, machine, bits) : bits;
}

// x - x is 0 for numbers, and NaN for infinities and NaN.
ir::ValueId StandardCode::is_valid(ExprId argument, const stdlib::FunctionRow& row) {
  Typed in = natural(argument);
  ir::Scalar machine = scalar(in.type);
  if (row.id == FunctionId::kIsValid) {
    ir::ValueId nothing = build_.binary(ir::Op::kSub, machine, in.value, in.value);
    return build_.compare(ir::Op::kEq, machine, nothing, build_.constant(machine, 0));
  }
  ir::ValueId bits = code_.machine_convert(in.value, machine, ir::Scalar::kU64);
  ir::ValueId number = code_.native(NativeId::kBcdToNumber, {bits});
  ir::ValueId bad = build_.constant(ir::Scalar::kU64, std::numeric_limits<uint64_t>::max());
  return build_.compare(ir::Op::kNe, ir::Scalar::kU64, number, bad);
}

}  // namespace frontend
