// What is left of data memory (A6): the free area, and the slack inside areas. By it people see
// which changes will fit.
#pragma once

#include <cstdint>

#include "ir/bytecode/image.h"

namespace vm {

struct AreaRoom {  // of areas of one kind, together, in bytes
  uint64_t areas = 0;
  uint64_t used = 0;
  uint64_t slack = 0;
};

struct MemoryReport {
  uint64_t capacity = 0;  // of data memory, in bytes
  uint64_t free = 0;
  uint64_t largest_free = 0;  // one area can have so much
  AreaRoom globals;
  AreaRoom programs;
  AreaRoom instances;
};

// Linear in the instances.
MemoryReport memory_report(const ir::Image& image);

}  // namespace vm
