// Binary coded decimals (IEC 61131-3 table 24). A digit above 9, and a number that the
// target cannot hold, trap: no result would be right.
#include "frontend/lower/value_code.h"
#include "frontend/sema/constants/constant.h"

namespace frontend {

ir::ValueId ValueCode::from_bcd(Typed from, ir::TypeId to, bool or_all_bits) {
  constexpr ir::Scalar kU64 = ir::Scalar::kU64;
  ir::ValueId bits = machine_convert(from.value, scalar(from.type), kU64);
  ir::ValueId number = native(stdlib::NativeId::kBcdToNumber, {bits});
  auto most = static_cast<uint64_t>(limits_of(scalar(to)).high);
  if (most > 9'999'999'999'999'999) most = 9'999'999'999'999'999;
  ir::ValueId checked = number;
  if (or_all_bits) {  // what is no BCD is all bits already, and one more is 0
    checked = build_.binary(ir::Op::kAdd, kU64, number, build_.constant(kU64, 1));
    ++most;
  }
  require(build_.compare(ir::Op::kLe, kU64, checked, build_.constant(kU64, most)));
  return machine_convert(number, kU64, scalar(to));
}

// A negative number is a very large one when it is read without sign.
ir::ValueId ValueCode::to_bcd(Typed from, ir::TypeId to) {
  constexpr ir::Scalar kU64 = ir::Scalar::kU64;
  ir::ValueId number = machine_convert(from.value, scalar(from.type), kU64);
  uint64_t most = 1;
  for (uint32_t digit = 0; digit < ir::scalar_size(scalar(to)) * 2; ++digit) most *= 10;
  require(build_.compare(ir::Op::kLt, kU64, number, build_.constant(kU64, most)));
  ir::ValueId bcd = native(stdlib::NativeId::kNumberToBcd, {number});
  return machine_convert(bcd, kU64, scalar(to));
}

void ValueCode::require(ir::ValueId condition, ir::TrapKind kind) {
  ir::BlockId good = build_.new_block();
  ir::BlockId bad = build_.new_block();
  build_.branch(condition, good, bad);
  build_.start(bad);
  build_.trap(kind);
  build_.start(good);
}

}  // namespace frontend
