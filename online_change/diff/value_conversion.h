// The value rules of A14 for one scalar or one string: what happens to a value
// when its variable keeps the name and changes the type. Pure functions; the
// planner asks classify(), the switch and the undo ask convert.
#pragma once

#include <cstdint>
#include <span>

#include "ir/types/types.h"

namespace online_change {

enum class Conversion : uint8_t {
  kNone,     // no rule: the new initial value is used
  kSame,     // every value has the same bits in both types
  kExact,    // every value can be carried over
  kMayLose,  // depends on the live value
};
Conversion classify(const ir::TypeTable& old_types, ir::TypeId old_type,
                    const ir::TypeTable& new_types, ir::TypeId new_type);

struct Converted {
  uint64_t bits = 0;           // as in ConstValue: sign-extended, REAL as f32 bits
  const char* loss = nullptr;  // "saturates", "inexact", ...; null when nothing is lost
  bool initialise = false;     // the value has no counterpart: use the initial value
};
// Elementary types. Only where a rule exists (classify() is not kNone).
Converted convert(ir::Kind from, ir::Kind to, uint64_t bits);
// Any scalar types: enumerations by literal, subranges clamp.
Converted convert_scalar(const ir::TypeTable& old_types, ir::TypeId old_type,
                         const ir::TypeTable& new_types, ir::TypeId new_type, uint64_t bits);

// Storage of a STRING (1 byte units) or WSTRING (2 byte units), terminator included.
// Fills all of `to`; returns what was lost, or null.
const char* convert_string(std::span<const uint8_t> from, uint32_t from_unit, std::span<uint8_t> to,
                           uint32_t to_unit);

}  // namespace online_change
