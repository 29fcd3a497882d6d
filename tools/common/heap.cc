#include "tools/common/heap.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tools {

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

}  // namespace tools
