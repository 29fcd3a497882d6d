// How far a reference may go: the bytes of the variable that it was taken from
// (docs/adr/0005-references-are-handles.md). The variable is not in the handle. It is the one that
// holds the byte `offset - distance`, where the distance is 0 inside of the variable, and outside
// of it one of six or seven to each side, which the handle's `away` numbers: so one past the end is
// the end of its own variable, and not the first byte of the next one. The distances grow by fours
// at most, so one of them leads back from everywhere near the variable, as long as that is large
// enough for the next step. What goes further is lost: no arithmetic brings it back. A pointer to
// an instance that is taken as one to something else may go wherever the instance has bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ir/types/handle.h"
#include "ir/types/layout.h"

namespace ir {

// Offsets in an area, or in a local: [begin, end).
struct Reach {
  uint32_t begin = 0;
  uint32_t end = 0;
  bool has_slots = false;  // set by whoever asks for it
  uint32_t size() const { return end - begin; }
  bool holds(uint32_t offset) const { return offset - begin < size(); }
  // All of [offset, offset + bytes)?
  bool covers(uint32_t offset, uint64_t bytes) const {
    return offset >= begin && offset + bytes <= end;
  }
};

inline constexpr int32_t kLost = -8;
inline constexpr int32_t kWhole = 7;  // of a whole instance

// The reaches of the variables of a type that has an area of its own, inherited ones included;
// sorted. Variables without bytes have none.
std::vector<Reach> area_reaches(const TypeTable& types, const Layouts& layouts, TypeId type);
// The one that holds the offset; none: its size is 0. Without branches on the offsets, which may be
// another variable's each time.
inline Reach reach_at(std::span<const Reach> sorted, uint32_t offset) {
  const Reach* found = sorted.data();
  for (size_t rest = sorted.size(); rest > 1;) {
    const size_t half = rest / 2;
    found += found[half].begin <= offset ? half : 0;
    rest -= half;
  }
  return sorted.empty() || !found->holds(offset) ? Reach() : *found;
}

// Is it inside of what it was taken from?
constexpr bool is_inside(uint64_t handle) {
  return handle_away(handle) == 0 || handle_away(handle) == kWhole;
}
// The byte in its variable that stands for the handle; of no meaning when the handle is lost.
uint32_t anchor_of(uint64_t handle);
// The reach of the variable that `handle` was taken from, in an area of so many bytes; no bytes:
// there is none.
Reach reach_of(std::span<const Reach> sorted, uint32_t area_bytes, uint64_t handle);
// `handle`, which was taken from the variable with that reach (without bytes: from none), moved by
// so many bytes, of which the low 32 bits count, with their sign. The same for one step as for
// several in one direction.
uint64_t moved_from(Reach reach, uint64_t handle, uint32_t bytes);
// More bytes than an offset has: whatever moves by so many is outside of every variable.
constexpr bool is_far(uint64_t bytes) {
  return static_cast<int64_t>(bytes) != static_cast<int32_t>(bytes);
}
constexpr uint64_t lost(uint64_t handle) { return with_away(handle, kLost); }
// The handle of segment `segment` that lies `position` bytes after the variable's begin.
uint64_t handle_in(Reach reach, uint32_t segment, int64_t position);

}  // namespace ir
