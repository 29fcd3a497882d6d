// Large pieces of memory that will be written as a whole.
#pragma once

#include <cstddef>

namespace base {

// Asks the system for large pages in what is not touched yet: one fault for each 2 MiB instead of
// 512. Only a hint; what the memory holds is the same.
void expect_whole_use(void* memory, size_t bytes);

}  // namespace base
