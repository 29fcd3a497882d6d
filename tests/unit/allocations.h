// How many pieces of the heap this thread has taken. A program that links allocations.cc counts them:
// by an operator new of its own, or by the hook of a sanitizer that has a heap of its own, where
// malloc counts too. Any thread; itself without allocation, lock and system call.
#pragma once

#include <cstdint>

namespace tests {

uint64_t allocations();

}  // namespace tests
