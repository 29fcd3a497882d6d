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

// One argument or result. Strings: `data` has room for capacity + 1 units.
struct NativeArg {
  uint64_t bits = 0;      // scalars, as ir::ConstValue::bits
  uint8_t* data = nullptr;
  uint32_t capacity = 0;  // in characters
};

using NativeFunction = uint64_t (*)(NativeArg* args);  // result bits

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
