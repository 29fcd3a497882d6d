#include "stdlib/native/natives.h"

#include <array>

#include "base/check.h"
#include "stdlib/native/implementation.h"

namespace stdlib {
namespace {

constexpr NativeRow row(std::string_view name, std::string_view signature,
                        NativeFunction function) {
  return {name, signature[0], signature.substr(2), function};
}

constexpr std::array kRows = {
#define NATIVE(id, name, signature, meaning) row(name, signature, &native<NativeId::id>),
#include "stdlib/native/natives.def"
#undef NATIVE
};

}  // namespace

uint32_t native_count() { return static_cast<uint32_t>(kRows.size()); }

const NativeRow& native_row(uint32_t id) {
  base::check(id < kRows.size(), "native function id is in natives.def");
  return kRows[id];
}

ir::Scalar native_scalar(char letter) {
  switch (letter) {
    case 'b':
      return ir::Scalar::kBool;
    case 'i':
      return ir::Scalar::kI32;
    case 'I':
      return ir::Scalar::kI64;
    case 'U':
      return ir::Scalar::kU64;
    case 'f':
      return ir::Scalar::kF32;
    case 'F':
      return ir::Scalar::kF64;
    case 'S':
      return ir::Scalar::kStr;
    case 'W':
      return ir::Scalar::kWstr;
    default:
      base::check_failed("signature letter has a scalar", std::source_location::current());
  }
}

}  // namespace stdlib
