// The bits of a reference (docs/adr/0005-references-are-handles.md): {offset : 32 low,
// segment : 32 high}; 0 is NULL. A segment names the area of an instance (ID 0: the globals)
// together with the generation of its ID, or, with the highest bit, a local whose address was
// taken. Handles are plain numbers: every use checks again what they name.
#pragma once

#include <cstdint>

namespace ir {

inline constexpr uint32_t kExposedBit = 0x80000000u;
inline constexpr uint32_t kSegmentIdMask = 0x00ffffffu;

constexpr uint32_t area_segment(uint32_t id, uint32_t generation) {
  return (id + 1) | (generation & 0x7f) << 24;
}
// The ID that an area's segment names; kSegmentIdMask and more: none.
constexpr uint32_t segment_id(uint32_t segment) {
  return (segment & kExposedBit) != 0 || segment == 0 ? 0xffffffffu
                                                      : (segment & kSegmentIdMask) - 1;
}
// The `count`-th local that task number `task` exposes; counts wrap after 2^24.
constexpr uint32_t exposed_segment(uint32_t task, uint32_t count) {
  return kExposedBit | (task & 0x7f) << 24 | (count & 0xffffff);
}
// The initial value of a reference that start code gives its value (`p : POINTER TO INT :=
// ADR(x)`): the NULL segment, so that it leads nowhere, and a number for the expression.
constexpr uint64_t unbound_handle(uint64_t expression) {
  return 0xa0000000u | (expression & 0x0fffffffu);
}
constexpr uint32_t handle_segment(uint64_t handle) { return static_cast<uint32_t>(handle >> 32); }
constexpr uint32_t handle_offset(uint64_t handle) { return static_cast<uint32_t>(handle); }
constexpr uint64_t make_handle(uint32_t segment, uint32_t offset) {
  return static_cast<uint64_t>(segment) << 32 | offset;
}
constexpr uint64_t move_handle(uint64_t handle, uint64_t bytes) {
  return make_handle(handle_segment(handle), handle_offset(handle) + static_cast<uint32_t>(bytes));
}

}  // namespace ir
