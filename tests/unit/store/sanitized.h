// Under AddressSanitizer a test of every call or bit takes twenty times as long: there it takes a
// sample, with every bit of a byte among it, which finds errors of memory as well. All of them are
// tried without it.
#pragma once

#include <cstdint>

#ifdef STC_SANITIZED_HEAP
inline constexpr uint64_t kOneOf = 9;
#else
inline constexpr uint64_t kOneOf = 1;
#endif
