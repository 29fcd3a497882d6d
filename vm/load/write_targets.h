// Variables as the search for their writers sees them (writers.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ir/bytecode/image.h"

namespace vm {

// A scalar or string in data memory.
struct Variable {
  uint32_t data = 0;
  uint32_t size = 0;
  ir::TypeId type;
};

// A value that a variable is, or is part of.
struct Around {
  ir::TypeId type;
  uint64_t offset = 0;  // of the variable in it
};

struct Target {
  uint64_t begin = 0;  // in data memory
  uint64_t end = 0;
  ir::TypeId type;
  uint32_t owner = 0;  // instance in whose area it lies; 0: the globals
  std::vector<Around> around;
  bool overlaid = false;      // in a union
  uint64_t member_begin = 0;  // of the owner's member that it is, or is part of
  uint64_t member_end = 0;
  bool in_out = false;   // its address may be bound to a VAR_IN_OUT
  bool retyped = false;  // by a reference, as a variable of any type
  bool referenced = false;
};

std::vector<Target> targets_of(const ir::Image& image, std::span<const Variable> variables);

}  // namespace vm
