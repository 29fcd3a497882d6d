// Allocations of a thread while it is watched. Included by one file of a program: it replaces
// operator new for all of it.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <new>

namespace {

thread_local bool watched = false;
thread_local uint64_t allocations = 0;

void* allocate(size_t size) {
  if (watched) ++allocations;
  return std::malloc(size != 0 ? size : 1);
}

}  // namespace

[[gnu::noinline]] void* operator new(size_t size) {
  void* memory = allocate(size);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
[[gnu::noinline]] void* operator new(size_t size, const std::nothrow_t&) noexcept {
  return allocate(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, size_t) noexcept { std::free(memory); }
