#include "frontend/sema/constants/constant.h"

#include <bit>

namespace frontend {

Limits limits_of(ir::Scalar scalar) {
  uint32_t bits = ir::scalar_size(scalar) * 8;
  if (scalar == ir::Scalar::kBool) return {0, 1};
  if (ir::is_signed(scalar)) {
    Wide half = static_cast<Wide>(1) << (bits - 1);
    return {-half, half - 1};
  }
  return {0, (static_cast<Wide>(1) << bits) - 1};
}

Wide wrap_to(ir::Scalar scalar, Wide value) {
  Limits limits = limits_of(scalar);
  Wide range = limits.high - limits.low + 1;
  Wide offset = (value - limits.low) % range;
  if (offset < 0) offset += range;
  return limits.low + offset;
}

std::string wide_text(Wide value) {
  bool negative = value < 0;
  unsigned __int128 rest =
      negative ? -static_cast<unsigned __int128>(value) : static_cast<unsigned __int128>(value);
  std::string digits;
  do {
    digits.insert(digits.begin(), static_cast<char>('0' + static_cast<int>(rest % 10)));
    rest /= 10;
  } while (rest != 0);
  return negative ? "-" + digits : digits;
}

Constant scalar_constant(const ir::TypeTable& types, ir::TypeId type, uint64_t bits) {
  Constant value;
  value.type = type;
  ir::Scalar scalar = types.scalar(type);
  if (scalar == ir::Scalar::kF32) {
    value.form = Constant::Form::kReal;
    value.real = std::bit_cast<float>(static_cast<uint32_t>(bits));
  } else if (scalar == ir::Scalar::kF64) {
    value.form = Constant::Form::kReal;
    value.real = std::bit_cast<double>(bits);
  } else {
    value.integer = ir::is_signed(scalar) ? static_cast<Wide>(static_cast<int64_t>(bits))
                                          : static_cast<Wide>(bits);
  }
  return value;
}

}  // namespace frontend
