#include "tools/common/heap.h"

#include <cstdint>
#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

namespace tools {
namespace {

constexpr size_t kLargePage = 2 << 20;
constexpr size_t kMostOfHeap = 512 << 20;

}  // namespace

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MXFAST, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TOP_PAD, 16 << 20);
#endif
}

void keep_large_pieces() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);
#endif
}

void expect_pieces(size_t bytes) {
#if defined(__GLIBC__) && defined(MADV_HUGEPAGE)
  if (bytes < 4 * kLargePage || bytes > kMostOfHeap) return;
  mallopt(M_TRIM_THRESHOLD, static_cast<int>(2 * bytes));
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TOP_PAD, static_cast<int>(bytes));
  void* const first = std::malloc(1 << 20);  // more than is left: the heap grows by all of it
  mallopt(M_TOP_PAD, 1 << 20);  // of heaps of other threads: what a system call gives at once
  const auto at = reinterpret_cast<uintptr_t>(first);
  const uintptr_t begin = (at + kLargePage - 1) / kLargePage * kLargePage;
  const auto end = reinterpret_cast<uintptr_t>(::sbrk(0));
  if (begin < end && end - at < 2 * bytes) {
    ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
  }
  std::free(first);
#else
  static_cast<void>(bytes);
#endif
}

}  // namespace tools
