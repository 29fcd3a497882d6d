// Scalars of the evaluator: pure functions from bits to bits. Bits are as in
// ConstValue: integers sign- or zero-extended by their type, REAL as f32 bits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "ir/program/ir.h"

namespace ir {

// A scalar result, or why there is none.
struct Outcome {
  uint64_t bits = 0;
  std::optional<TrapKind> trap;
  std::string text;  // operands of the trap
};

// The low bits of a value as its scalar keeps them.
uint64_t canonical(Scalar scalar, uint64_t bits);
// Canonical bits of an integer scalar for people.
std::string integer_text(Scalar scalar, uint64_t bits);

// add sub mul div mod min max and or xor, and the comparisons.
Outcome eval_binary(Op op, Scalar scalar, uint64_t a, uint64_t b);
// neg abs sqrt not
uint64_t eval_unary(Op op, Scalar scalar, uint64_t a);
// shl shr rol ror
uint64_t eval_shift(Op op, Scalar scalar, uint64_t a, uint32_t count);
// wrap tofloat round trunc tobool bits
Outcome eval_conversion(Op op, Scalar from, Scalar to, uint64_t a);
Outcome eval_check_range(Scalar scalar, uint64_t a, int64_t low, int64_t high);

// Does `op` make its result from its operands alone? The arithmetic, conversions and checks of
// ops.def.
bool is_scalar_operation(Op op);
// Any of them. `from`: the scalar of the first operand.
Outcome eval_operation(const Inst& inst, Scalar from, std::span<const uint64_t> operands);

}  // namespace ir
