// Under AddressSanitizer what tries every call, bit or source takes twenty times as long: there it
// takes one of so many, every bit of a byte among them, which finds errors of memory as well. All of
// them are tried without it.
#pragma once

#include <cstdint>

#ifdef STC_SANITIZED_HEAP
inline constexpr uint64_t kOneOf = 9;
#else
inline constexpr uint64_t kOneOf = 1;
#endif
