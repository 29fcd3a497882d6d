// Native standard functions: the table and their implementations, shared by the
// virtual machine and the evaluator. Pure functions of their arguments: no state,
// no allocation, no system call. Strings are bounded by their capacity even when
// no NUL is found.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "ir/types/types.h"

namespace stdlib {

enum class NativeId : uint16_t {
#define NATIVE(id, name, signature, meaning) id,
#include "stdlib/native/natives.def"
#undef NATIVE
};
uint32_t native_count();

// Arguments come as they lie in their slots of 8 bytes, and so does the result: of scalars only the
// low bytes count, what is above is arbitrary. A string is {offset:32, capacity:32} in `memory`,
// with room for capacity + 1 units. Of more than kDirectArguments arguments `a` is the slots'
// address.
using NativeFunction = uint64_t (*)(uint8_t* memory, uint64_t a, uint64_t b, uint64_t c, uint64_t d,
                                    uint64_t e);
inline constexpr uint32_t kDirectArguments = 5;

// From slots, and the result into the first of them.
using NativeSlots = void (*)(uint8_t* memory, uint8_t* slots);
extern const NativeSlots kNativeSlots[];  // by id

struct NativeRow {
  std::string_view name;
  char result;                 // letter of the signature
  std::string_view arguments;  // letters
  NativeFunction function;
};
// `id` < native_count().
const NativeRow& native_row(uint32_t id);

// The machine scalar of a signature letter (not for 'v').
ir::Scalar native_scalar(char letter);

}  // namespace stdlib
