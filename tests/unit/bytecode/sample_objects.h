// A small hand-made image of objects: an interface, a block that extends another and overrides its
// method, virtual calls, a try. As sample_image.h, for tests that change one thing in it.
#pragma once

#include "tests/unit/bytecode/sample_image.h"

namespace sample {

// POUs. `add` takes x and returns r, both INT: n := n + x; r := n. What Derived.add does besides
// is to add 1 to `extra`.
inline constexpr uint32_t kAdderAdd = 0;  // of the interface
inline constexpr uint32_t kBaseBody = 1;
inline constexpr uint32_t kBaseAdd = 2;
inline constexpr uint32_t kDerivedBody = 3;
inline constexpr uint32_t kDerivedAdd = 4;
inline constexpr uint32_t kObjectMain = 5;
// Main: base Base, derived Derived, x INT, ref ULINT, kind UDINT, is BOOL.
inline constexpr uint32_t kBaseSlot = 0;
inline constexpr uint32_t kDerivedSlot = 4;
inline constexpr uint32_t kObjectX = 8;
inline constexpr uint32_t kObjectRef = 16;
inline constexpr uint32_t kObjectKind = 24;
inline constexpr uint32_t kObjectIs = 28;
// Frame of Main: w INT, b BOOL, d UDINT, h ULINT, addr of an INT, another; the next one.
inline constexpr uint32_t kW = 0;
inline constexpr uint32_t kB = 2;
inline constexpr uint32_t kD = 4;
inline constexpr uint32_t kH = 8;
inline constexpr uint32_t kAddr = 16;
inline constexpr uint32_t kAddrOther = 20;
inline constexpr uint32_t kObjectNext = 24;
inline constexpr uint16_t kSlotAddr = 4;
// Frame of `add`.
inline constexpr uint32_t kParamX = kObjectNext + 0;
inline constexpr uint32_t kParamR = kObjectNext + 2;

struct ObjectTypes {
  ir::TypeId adder, base, derived, main;
};
ObjectTypes object_types(const ir::Image& image);

Code argument();  // x := 4
Code call_slot(Opcode opcode, Operand slot, uint32_t x);
Code call_handle(Opcode opcode, uint32_t x);  // what Main.ref names
// With Main's code as given; it needs a RET.
ir::Image object_image(const Code& code, std::vector<ir::Merge> merges = {});
// Main calls everything in every way.
ir::Image busy_object_image();

}  // namespace sample
