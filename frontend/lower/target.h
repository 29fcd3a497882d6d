// What expressions come to on their way to code: values with their types, receivers of calls,
// and what can be assigned.
#pragma once

#include <optional>

#include "frontend/sema/model.h"
#include "ir/program/ir.h"

namespace frontend {

struct Typed {
  ir::ValueId value;
  ir::TypeId type;
};

// On which instance a method runs: a place, what a reference leads to, or else the own one.
struct Receiver {
  std::optional<ir::Place> place;
  std::optional<ir::ValueId> handle;
  bool fixed = false;  // SUPER: the base's method, whatever overrides it
};

// What came of a type test: whether the instance is what was wanted, and what is stored.
struct Attempt {
  ir::ValueId fits;
  ir::ValueId handle;
};

// What a call gives: the scalar result, or its place in a temporary.
struct CallResult {
  ir::ValueId value;
  ir::Place place;
};

// Something that can be assigned: a place, a character of a string place, or some bits of either.
struct Target {
  ir::Place place;
  ir::TypeId type;        // of what is assigned
  ir::ValueId character;  // valid: the one at this position of a string
  uint32_t bit_size = 0;  // 0: the whole place
  uint32_t bit_offset = 0;
  // A property: scalars go to its setter; others into `place` first, see settle().
  uint32_t getter = kNoPou;
  uint32_t setter = kNoPou;
  Receiver receiver;
};

}  // namespace frontend
