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

// The bytes that a scalar of the letter has in its slot.
constexpr size_t bytes_of(char letter) {
  return letter == 'v' ? 0 : letter == 'b' ? 1 : letter == 'i' || letter == 'f' ? 4 : 8;
}

template <NativeId id, size_t... i>
void by_slots(uint8_t* memory, uint8_t* slots, std::index_sequence<i...>) {
  constexpr std::string_view kLetters = kSignature<id>.substr(2);
  uint64_t all[kDirectArguments] = {};
  if constexpr (kLetters.size() > kDirectArguments) {
    all[0] = reinterpret_cast<uint64_t>(slots);
  } else {
    (std::memcpy(&all[i], slots + 8 * i, bytes_of(kLetters[i])), ...);
  }
  const uint64_t result = native<id>(memory, all[0], all[1], all[2], all[3], all[4]);
  std::memcpy(slots, &result, bytes_of(kSignature<id>[0]));
}
template <NativeId id>
void by_slots(uint8_t* memory, uint8_t* slots) {
  by_slots<id>(memory, slots, std::make_index_sequence<kSignature<id>.size() - 2>());
}

}  // namespace

constinit const NativeSlots kNativeSlots[] = {
#define NATIVE(id, name, signature, meaning) &by_slots<NativeId::id>,
#include "stdlib/native/natives.def"
#undef NATIVE
};

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
