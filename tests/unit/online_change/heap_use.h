// What a piece of work takes of the heap, given back or not: allocation_test.cc has this program's
// operator new.
#pragma once

#include <cstdint>
#include <functional>

namespace tests {

struct HeapUse {
  int64_t allocations = 0;
  uint64_t bytes = 0;
};
HeapUse heap_use_of(const std::function<void()>& job);

}  // namespace tests
