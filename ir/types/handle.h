// The bits of a reference (docs/adr/0005-references-are-handles.md): {offset : 32 low, segment :
// 28, away : 4 high}; 0 is NULL. A segment names the area of an instance (ID 0: the globals)
// together with the generation of its ID, or, with its highest bit, a local whose address was
// taken. `away` says how far the offset has left the variable that the reference was taken from
// (reach.h). Handles are plain numbers: every use checks again what they name.
#pragma once

#include <cstdint>

namespace ir {

inline constexpr uint32_t kSegmentBits = 28;
inline constexpr uint32_t kSegmentMask = (1u << kSegmentBits) - 1;
inline constexpr uint32_t kExposedBit = 1u << (kSegmentBits - 1);
inline constexpr uint32_t kSegmentIdMask = 0x00ffffffu;
// What two references to the same byte have in common, however they got there.
inline constexpr uint64_t kPlaceMask = (uint64_t{1} << (32 + kSegmentBits)) - 1;

constexpr uint32_t area_segment(uint32_t id, uint32_t generation) {
  return (id + 1) | (generation & 0x7) << 24;
}
// The ID that an area's segment names; kSegmentIdMask and more: none.
constexpr uint32_t segment_id(uint32_t segment) {
  return (segment & kExposedBit) != 0 || segment == 0 ? 0xffffffffu
                                                      : (segment & kSegmentIdMask) - 1;
}
// The `count`-th local that task number `task` exposes; counts wrap after 2^21.
constexpr uint32_t exposed_segment(uint32_t task, uint32_t count) {
  return kExposedBit | (task & 0x3f) << 21 | (count & 0x1fffff);
}
// The initial value of a reference that start code gives its value (`p : POINTER TO INT :=
// ADR(x)`): the NULL segment, so that it leads nowhere, and a number for the expression.
constexpr uint64_t unbound_handle(uint64_t expression) {
  return 0xa0000000u | (expression & 0x0fffffffu);
}
constexpr uint32_t handle_segment(uint64_t handle) {
  return static_cast<uint32_t>(handle >> 32) & kSegmentMask;
}
constexpr uint32_t handle_offset(uint64_t handle) { return static_cast<uint32_t>(handle); }
constexpr uint64_t make_handle(uint32_t segment, uint32_t offset) {
  return static_cast<uint64_t>(segment) << 32 | offset;
}
// The byte that the handle names, whatever variable it was taken from.
constexpr uint64_t handle_place(uint64_t handle) { return handle & kPlaceMask; }
// -8 to 7, reach.h says what they mean; 0: in its variable.
constexpr int32_t handle_away(uint64_t handle) {
  return static_cast<int32_t>(static_cast<int64_t>(handle) >> (32 + kSegmentBits));
}
constexpr uint64_t with_away(uint64_t handle, int32_t away) {
  return handle_place(handle) | static_cast<uint64_t>(away) << (32 + kSegmentBits);
}
// Moves the handle of something without a variable: the offset moves, and wraps; all else stays.
constexpr uint64_t move_offset(uint64_t handle, uint64_t bytes) {
  return (handle & ~uint64_t{0xffffffffu}) | (handle_offset(handle) + static_cast<uint32_t>(bytes));
}

}  // namespace ir
