// Instruction units and the decoded opcode table (opcodes.def).
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "ir/types/types.h"

namespace ir {

enum class Opcode : uint16_t {
#define OP(name, a, b, c, x, y, flags, meaning) name,
#include "ir/bytecode/opcodes.def"
#undef OP
};
inline constexpr uint32_t kOpcodeCount = 0
#define OP(name, a, b, c, x, y, flags, meaning) +1
#include "ir/bytecode/opcodes.def"
#undef OP
    ;
static_assert(kOpcodeCount <= 1024, "opcode field has 10 bits");

// What an operand field is relative to.
enum class Base : uint8_t { kFrame, kSelf, kGlobal, kConst };

// Class of a value in frames and leaves, as the verifier sees it.
enum class Class : uint8_t { kB, k8, k16, k32, k64, kF32, kF64, kA, kS, kW };
inline constexpr uint32_t kClassCount = 10;
Class class_of(Scalar scalar);
constexpr uint32_t class_size(Class cls) {
  constexpr uint8_t kBytes[kClassCount] = {1, 1, 2, 4, 8, 4, 8, 4, 8, 8};
  return kBytes[static_cast<uint32_t>(cls)];
}
std::string_view class_name(Class cls);

enum class FieldKind : uint8_t {
  kNone,
  kDst,
  kSrc,
  kRead,
  kTemp,
  kFrameRead,
  kUpdate,  // - D S R T F U
  kBase,    // only the base bits of this field count; offset in x or y
  kOffset16,
  kBc32,
  kFrameSize,
  kCode,
  kNative,
  kRange,
  kTrap,
  kRel32,
  kPlace32,
  kBounds,
  kType,
  kSize,
  kCapacity,
  kOffset32,
  kNumber,
};

struct Field {
  FieldKind kind = FieldKind::kNone;
  Class cls = Class::kB;  // for kDst..kUpdate
  constexpr bool is_near() const { return kind >= FieldKind::kDst && kind <= FieldKind::kUpdate; }
  constexpr bool reads() const {
    return kind == FieldKind::kSrc || kind == FieldKind::kRead || kind == FieldKind::kFrameRead ||
           kind == FieldKind::kUpdate;
  }
  constexpr bool writes() const {
    return kind == FieldKind::kDst || kind == FieldKind::kTemp || kind == FieldKind::kUpdate;
  }
  // May the field have this base?
  constexpr bool allows(Base base) const {
    switch (kind) {
      case FieldKind::kDst:
      case FieldKind::kRead:
        return base != Base::kConst;
      case FieldKind::kSrc:
      case FieldKind::kBase:
      case FieldKind::kBc32:
        return true;
      default:
        return base == Base::kFrame;
    }
  }
};

struct OpcodeRow {
  std::string_view name;
  Field a, b, c, x, y;
  bool extended = false;  // two units
  bool traps = false;
  bool backward = false;
  bool calls = false;
  bool ends = false;
  std::string_view meaning;
};
const OpcodeRow& opcode_row(Opcode op);
// The opcode of that name; kOpcodeCount as value when there is none.
Opcode opcode_from_name(std::string_view name);

struct Unit {
  uint16_t op = 0;
  uint16_t a = 0;
  uint16_t b = 0;
  uint16_t c = 0;

  static constexpr Unit make(Opcode opcode, Base base_a = Base::kFrame, Base base_b = Base::kFrame,
                             Base base_c = Base::kFrame) {
    return {static_cast<uint16_t>(
                static_cast<uint32_t>(opcode) | static_cast<uint32_t>(base_a) << 10 |
                static_cast<uint32_t>(base_b) << 12 | static_cast<uint32_t>(base_c) << 14),
            0, 0, 0};
  }
  static constexpr Unit extension(uint32_t x, uint32_t y) {
    return {static_cast<uint16_t>(x), static_cast<uint16_t>(x >> 16), static_cast<uint16_t>(y),
            static_cast<uint16_t>(y >> 16)};
  }
  // The opcode number; may be >= kOpcodeCount in hostile images.
  constexpr uint16_t opcode_number() const { return op & 0x3ff; }
  constexpr Opcode opcode() const { return static_cast<Opcode>(opcode_number()); }
  constexpr Base base_a() const { return static_cast<Base>(op >> 10 & 3); }
  constexpr Base base_b() const { return static_cast<Base>(op >> 12 & 3); }
  constexpr Base base_c() const { return static_cast<Base>(op >> 14 & 3); }
  constexpr uint32_t bc() const { return b | static_cast<uint32_t>(c) << 16; }
  constexpr void set_bc(uint32_t v) {
    b = static_cast<uint16_t>(v);
    c = static_cast<uint16_t>(v >> 16);
  }
  // The fields of an extension unit:
  constexpr uint32_t x() const { return op | static_cast<uint32_t>(a) << 16; }
  constexpr uint32_t y() const { return b | static_cast<uint32_t>(c) << 16; }
  friend bool operator==(const Unit&, const Unit&) = default;
};
static_assert(sizeof(Unit) == 8);

// A region is what an addr points to: a value of `type`, or when `dim` is not 0
// the part of an array left after indexing its first `dim` dimensions. For an
// instance type the region is the instance's whole area. Leaf lookup in a region
// is leaf_at() in regions.h.
struct Region {
  TypeId type;
  uint8_t dim = 0;
  friend bool operator==(const Region&, const Region&) = default;
};

}  // namespace ir
