// Bytes of the heap that are in use; under a sanitizer, of its heap.
#pragma once

#include <cstddef>
#include <cstdint>

#ifdef STC_SANITIZED_HEAP
// As <sanitizer/allocator_interface.h> declares it, which not every g++ brings along.
extern "C" size_t __sanitizer_get_current_allocated_bytes();
#else
#include <malloc.h>
#endif

namespace sim {

inline uint64_t heap_use() {
#ifdef STC_SANITIZED_HEAP
  return __sanitizer_get_current_allocated_bytes();
#else
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
#endif
}

}  // namespace sim
