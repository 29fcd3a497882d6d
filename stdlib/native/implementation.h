// Inside of stdlib/native: one specialisation per row of natives.def, and the
// access to arguments that they share. A row without a body does not link.
#pragma once

#include <bit>
#include <cstdint>

#include "stdlib/native/natives.h"

namespace stdlib {

template <NativeId id>
uint64_t native(NativeArg* args);

#define NATIVE(id, name, signature, meaning) \
  template <>                                \
  uint64_t native<NativeId::id>(NativeArg * args);
#include "stdlib/native/natives.def"
#undef NATIVE

inline int64_t int_of(const NativeArg& arg) { return static_cast<int64_t>(arg.bits); }
inline double double_of(const NativeArg& arg) { return std::bit_cast<double>(arg.bits); }
inline float float_of(const NativeArg& arg) {
  return std::bit_cast<float>(static_cast<uint32_t>(arg.bits));
}
inline uint64_t bits_of(int64_t value) { return static_cast<uint64_t>(value); }
inline uint64_t bits_of(double value) { return std::bit_cast<uint64_t>(value); }

}  // namespace stdlib
