#include "tests/unit/allocations.h"

#include <cstdlib>
#include <new>

namespace {

thread_local uint64_t counted = 0;

}  // namespace

namespace tests {

uint64_t allocations() { return counted; }

}  // namespace tests

#ifdef STC_SANITIZED_HEAP

// As <sanitizer/allocator_interface.h> declares it, which not every g++ brings along.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*taken)(const volatile void*, size_t),
                                                         void (*freed)(const volatile void*));

namespace {

[[maybe_unused]] const int installed = __sanitizer_install_malloc_and_free_hooks(
    [](const volatile void*, size_t) { ++counted; }, [](const volatile void*) {});

}  // namespace

#else

// Not inlined, or the compiler takes malloc and delete for a mismatched pair.
[[gnu::noinline]] void* operator new(size_t size) {
  ++counted;
  if (void* block = std::malloc(size != 0 ? size : 1)) return block;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
  ++counted;
  return std::malloc(size != 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* block) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, size_t) noexcept { std::free(block); }

#endif
