// Division and MOD; by a constant as a multiplication by its reciprocal, rounded up, of as many
// bits as the number has and some more. The classic conditions say when that is exact: Granlund,
// Montgomery, "Division by Invariant Integers using Multiplication".
#include <bit>

#include "vm/native/build.h"
#include "vm/native/ranges.h"

namespace vm::native {
namespace {

using Wide = unsigned __int128;

struct Reciprocal {
  uint64_t magic = 0;  // 2^(64 + shift) / divisor, rounded up
  unsigned shift = 0;
  bool exact = false;  // it fits, and is exact for all numbers of so many bits
};

// For numbers below 2^bits, the divisor being no power of two.
Reciprocal reciprocal_of(uint64_t divisor, unsigned bits) {
  for (unsigned shift = 0; shift < 64; ++shift) {
    const Wide power = static_cast<Wide>(1) << (64 + shift);
    const Wide magic = power / divisor + 1;
    if (magic >> 64 != 0) break;
    const Wide error = magic * divisor - power;
    if (error <= static_cast<Wide>(1) << (64 + shift - bits)) {
      return {static_cast<uint64_t>(magic), shift, true};
    }
  }
  return {};
}

}  // namespace

// Numbers of 8 bytes without sign that are less than 2^bits, by no power of two.
Val Builder::unsigned_quotient(Val left, unsigned bits, uint64_t divisor) {
  const auto shifted = [&](Val v, unsigned by) {
    return by == 0 ? v : int_op(Op::kShr, 8, v, constant(by, 4, false));
  };
  const auto high = [&](Val v, uint64_t magic) {
    return int_op(Op::kMulHighU, 8, v, constant(magic, 8, false));
  };
  const Reciprocal direct = reciprocal_of(divisor, bits);
  if (direct.exact) return shifted(high(left, direct.magic), direct.shift);
  const auto zeros = static_cast<unsigned>(std::countr_zero(divisor));
  const Reciprocal halved = reciprocal_of(divisor >> zeros, bits - zeros);
  if (zeros != 0 && halved.exact) {
    return shifted(high(shifted(left, zeros), halved.magic), halved.shift);
  }
  // The reciprocal has 65 bits, whose first is a sum.
  const auto log = static_cast<unsigned>(std::bit_width(divisor));
  const Wide rest = (static_cast<Wide>(1) << log) - divisor;
  const auto magic = static_cast<uint64_t>((rest << 64) / divisor + 1);
  const Val product = high(left, magic);
  const Val half = shifted(int_op(Op::kSub, 8, left, product), 1);
  return shifted(int_op(Op::kAdd, 8, half, product), log - 1);
}

// With sign: one of them is a negative number to the machine when it has 64 bits.
Val Builder::signed_quotient(Val left, uint64_t divisor) {
  const Reciprocal found = reciprocal_of(divisor, 63);
  Val high = int_op(Op::kMulHighS, 8, left, constant(found.magic, 8, false));
  if (found.magic >> 63 != 0) high = int_op(Op::kAdd, 8, high, left);
  if (found.shift != 0) high = int_op(Op::kSar, 8, high, constant(found.shift, 4, false));
  const Val sign = int_op(Op::kSar, 8, left, constant(63, 4, false));
  return int_op(Op::kSub, 8, high, sign);
}

// Numbers of 32 bits in registers of 64, by no power of two.
Val Builder::quotient_of_32_bits(bool is_signed, Val left, uint64_t divisor) {
  if (is_signed) {
    unsigned k = 0;
    while ((uint64_t{1} << k) < divisor) ++k;
    const uint64_t magic = (uint64_t{1} << (31 + k)) / divisor + 1;
    const Val wide = extended(left, 4, true);
    const Val product = int_op(Op::kMul, 8, wide, constant(magic, 8, false));
    const Val high = int_op(Op::kSar, 8, product, constant(31 + k, 4, false));
    const Val sign = int_op(Op::kSar, 8, wide, constant(63, 4, false));
    return extended(int_op(Op::kSub, 8, high, sign), 4, false);
  }
  const Val wide = extended(left, 4, false);
  for (unsigned k = 0; k < 32; ++k) {
    // Exact for every 32-bit number when the reciprocal's error is small enough.
    const Wide power = static_cast<Wide>(1) << (32 + k);
    const auto magic = static_cast<uint64_t>((power + divisor - 1) / divisor);
    if (magic >> 32 != 0) break;
    const auto error = static_cast<uint64_t>(static_cast<Wide>(magic) * divisor - power);
    if (error > (uint64_t{1} << k)) continue;
    const Val product = int_op(Op::kMul, 8, wide, constant(magic, 8, false));
    return extended(int_op(Op::kShr, 8, product, constant(32 + k, 4, false)), 4, false);
  }
  return extended(unsigned_quotient(wide, 32, divisor), 4, false);
}

// Towards zero. A power of two: a sum that rounds negative numbers up, then a shift.
Val Builder::quotient_by_constant(bool is_signed, uint8_t width, Val left, uint64_t divisor) {
  const unsigned bits_ = 8u * width;
  if (divisor == 1) return left;
  if (std::has_single_bit(divisor)) {
    const unsigned k = static_cast<unsigned>(std::countr_zero(divisor));
    if (!is_signed) return int_op(Op::kShr, width, left, constant(k, 4, false));
    const Val sign = int_op(Op::kSar, width, left, constant(bits_ - 1, 4, false));
    const Val rest = int_op(Op::kShr, width, sign, constant(bits_ - k, 4, false));
    const Val sum = int_op(Op::kAdd, width, left, rest);
    return int_op(Op::kSar, width, sum, constant(k, 4, false));
  }
  if (width == 4) return quotient_of_32_bits(is_signed, left, divisor);
  return is_signed ? signed_quotient(left, divisor) : unsigned_quotient(left, 64, divisor);
}

// The quotient by a negative number is that by its size with the other sign; the most negative one
// is its own size, a power of two.
void Builder::divide_by_constant(const Recipe& recipe, Val left, uint64_t divisor) {
  const bool remainder = recipe.op == Op::kModS || recipe.op == Op::kModU;
  const uint8_t width = recipe.width;
  const bool negative = recipe.is_signed && (divisor >> (8 * width - 1) & 1) != 0;
  const uint64_t size = negative ? (~divisor + 1) & mask(width) : divisor;
  if (remainder && size == 1) return write_a(constant(0, width, false));
  if (remainder && !recipe.is_signed && std::has_single_bit(divisor)) {
    return write_a(int_op(Op::kAnd, width, left, constant(divisor - 1, width, false)));
  }
  Val operand = left;
  uint8_t at = width;
  if (width < 4) {
    operand = extended(left, width, recipe.is_signed);
    at = 4;
  }
  Val quotient = quotient_by_constant(recipe.is_signed, at, operand, size);
  if (!remainder) return write_a(negative ? int_op(Op::kNeg, at, quotient) : quotient);
  const Val product = int_op(Op::kMul, at, quotient, constant(size, at, false));
  write_a(int_op(Op::kSub, at, operand, product));
}

void Builder::divide(const Recipe& recipe) {
  Val left = read_b();
  Val right = read_c();
  if (is_constant(right) && (bits(right) & mask(recipe.width)) != 0) {
    return divide_by_constant(recipe, left, bits(right) & mask(recipe.width));
  }
  exit_if(Cond::kEq, recipe.width, right, zero());
  uint8_t width = recipe.width;
  if (width < 4) {
    left = extended(left, width, recipe.is_signed);
    right = extended(right, width, recipe.is_signed);
    width = 4;
  }
  write_a(int_op(recipe.op, width, left, right));
}

}  // namespace vm::native
