#include "base/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace base {
namespace {

constexpr uintptr_t kLargePage = 2u << 20;

}  // namespace

void expect_whole_use(void* memory, size_t bytes) {
  const auto begin = reinterpret_cast<uintptr_t>(memory);
  const uintptr_t first = (begin + kLargePage - 1) / kLargePage * kLargePage;
  const uintptr_t end = (begin + bytes) / kLargePage * kLargePage;
  // Where there are none, the small ones do.
  if (first < end) ::madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
}

}  // namespace base
