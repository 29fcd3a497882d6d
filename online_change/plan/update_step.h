// Update records (A3, A13): what is done to data memory, a step for values that are made alike.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "base/bytes.h"
#include "ir/types/types.h"

namespace online_change {

inline constexpr uint32_t kNoFate = 0xffffffffu;  // UpdateStep::fate: no variable, an instance slot

// The values that a declaration gives.
struct InitialValues {
  base::Bytes bytes;   // of all values, end to end; empty: zeros
  bool early = false;  // into bytes that version 1 does not own: done while it runs (A19)
};
// Value i is at from + i * from_stride, as it is.
struct CopiedValues {
  uint32_t from = 0;
  uint32_t from_stride = 0;
};
// Value i, a scalar or a string, is at from + i * from_stride and converted by A14.
struct ConvertedValues {
  uint32_t from = 0;
  uint32_t from_stride = 0;
  ir::TypeId old_type;  // in the old image
  ir::TypeId new_type;  // in the new one
  // On the controller: what an edit that is taken out has made of which values, and these
  // (apply/live_value.h). In packages empty.
  base::Bytes known;
};
// A step of a chart: the one at `from`, or where the one at `active` is active, that one.
struct EnteredStep {
  uint32_t from = 0;
  uint32_t active = 0;
};
// What a migration gives.
struct GivenValue {
  uint32_t call = 0;  // in Plan::calls
  uint32_t slot = 0;  // place in the function's frame
  ir::TypeId type;    // in the image that is made
  base::Bytes made;   // on the controller; in packages empty
};
// Bytes and bits that stay at their %M or %Q address.
struct GatheredBits {
  uint32_t row = 0;  // in Plan::gathers
  base::Bytes rest;  // what no part of the row gives, of the whole value; empty: zeros
};

// As stored, and as shown: the alternatives of UpdateStep::how in their order.
enum class StepKind : uint8_t { kInitialise, kCopy, kConvert, kEnter, kMigrate, kGather };

// `count` values of `size` bytes each, value i at to + i * to_stride, all made in one of six ways.
// Offsets are in data memory.
struct UpdateStep {
  uint32_t to = 0;
  uint32_t size = 0;  // of one value in the new version
  uint32_t count = 1;
  uint32_t to_stride = 0;
  uint32_t fate = kNoFate;  // row of Plan::fates
  std::variant<InitialValues, CopiedValues, ConvertedValues, EnteredStep, GivenValue, GatheredBits>
      how = CopiedValues{};

  StepKind kind() const { return static_cast<StepKind>(how.index()); }
  template <class How>
  const How* as() const {
    return std::get_if<How>(&how);
  }
  template <class How>
  How* as() {
    return std::get_if<How>(&how);
  }
  bool early() const;
  // Where its values are; null: they are not read at one place each.
  std::optional<CopiedValues> source() const;
  // Bytes of the plan that it writes, or begins with; null: none, it has a source.
  const base::Bytes* bytes() const;
  uint32_t place(uint32_t index) const { return to + index * to_stride; }
  // From the first value's first byte to the last one's end.
  uint64_t hull() const { return uint64_t{to_stride} * (count - 1) + size; }
  uint64_t total() const { return uint64_t{size} * count; }
};

}  // namespace online_change
