// Which bits an operation on REAL or LREAL gives when its result is no number. C++ and the machines
// leave that open; here it is the first operand that is none, made quiet, else the negative one
// without anything in it, which is what x86-64 gives (docs/adr/0021).
#pragma once

#include <bit>
#include <cstdint>
#include <type_traits>

#include "ir/types/types.h"

namespace ir {

// Is the constant no number?
constexpr bool is_nan(Scalar scalar, uint64_t bits) {
  if (scalar == Scalar::kF32) return (bits & 0x7fffffffu) > 0x7f800000u;
  return scalar == Scalar::kF64 && (bits & ~uint64_t{0} >> 1) > uint64_t{0x7ff} << 52;
}

template <class Float>
constexpr Float made_quiet(Float nan) {
  if constexpr (sizeof(Float) == 4) {
    return std::bit_cast<float>(std::bit_cast<uint32_t>(nan) | uint32_t{1} << 22);
  } else {
    return std::bit_cast<double>(std::bit_cast<uint64_t>(nan) | uint64_t{1} << 51);
  }
}

template <class Float>
constexpr Float default_nan() {
  if constexpr (sizeof(Float) == 4) {
    return std::bit_cast<float>(0xffc00000u);
  } else {
    return std::bit_cast<double>(0xfff8000000000000u);
  }
}

// `result`: of an operation on a and b, as the machine has it; of one operand, give it twice. No
// call and nothing but selections: it stands in the handlers of the interpreter.
template <class Float>
constexpr Float with_nan_of(Float result, Float a, Float b) {
  static_assert(std::is_floating_point_v<Float>);
  if (result == result) [[likely]]
    return result;
  if (a != a) return made_quiet(a);
  return b != b ? made_quiet(b) : default_nan<Float>();
}

}  // namespace ir
