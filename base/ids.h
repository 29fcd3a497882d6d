// Id<Tag>: a typed 32-bit index into a store owned by somebody else. Ids, not
// pointers, link the program's data structures; an Id never owns anything.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>

namespace base {

template <class Tag>
struct Id {
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t index = kNone;

  constexpr Id() = default;
  constexpr explicit Id(uint32_t i) : index(i) {}
  constexpr bool valid() const { return index != kNone; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

}  // namespace base

template <class Tag>
struct std::hash<base::Id<Tag>> {
  size_t operator()(base::Id<Tag> id) const noexcept { return std::hash<uint32_t>()(id.index); }
};
