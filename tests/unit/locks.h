// How many mutexes this thread has locked. A program that links locks.cc counts them, by a
// pthread_mutex_lock of its own; under a sanitizer, which has one too, none is counted.
#pragma once

#include <cstdint>

namespace tests {

uint64_t locks();

}  // namespace tests
